// The fields of a scene file (sim/scene_fields.h): a surface, and what the solver is told of it.
#pragma once

#include "sim/fields/effects.h"

namespace laterna {

template <class Visitor>
void describe(Visitor& visit, MeshBelief& belief) {
  visit(
      Field{.key = "file",
            .sentence = "Another mesh file, in the mesh's `unit`, axes and placement, without displacement; "
                        "relative to the scene file. Absent: the true mesh."},
      belief.file);
  visit(Field{.key = "keep",
              .sentence = "Share of its triangles that is left, as far as its topology allows.",
              .low = 0,
              .high = 1,
              .low_excluded = true},
        belief.keep);
  visit(Field{.key = "noise_sigma_m",
              .unit = "m",
              .sentence = "Standard deviation by which each vertex is moved along its normal.",
              .low = 0,
              .high = farthest_m},
        belief.noise_sigma_m);
  visit(Field{.key = "seed", .sentence = "Draws that noise.", .low = 0}, belief.seed);
  visit(Field{.key = "scale",
              .sentence = "Enlarges it about its own origin, where the true mesh has it,",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        belief.scale);
  visit(Field{.key = "rotate_deg",
              .unit = "deg",
              .sentence = "turns it there about the world's x axis, then y, then z,",
              .low = -36000,
              .high = 36000},
        belief.rotate_deg);
  visit(Field{.key = "translate",
              .unit = "m",
              .sentence = "and moves it.",
              .low = -farthest_m,
              .high = farthest_m},
        belief.translate);
}

template <class Visitor>
void describe(Visitor& visit, MeshSpec& mesh) {
  visit(Field{.key = "name",
              .sentence = "What messages and pictures call it. Absent: the file's or the shape's name."},
        mesh.name);
  visit(
      Field{.key = "file",
            .sentence = "A mesh file (PLY, OBJ, STL, glTF, IFC, ..., also .gz), relative to the scene file."},
      mesh.file);
  visit(Field{.key = "shape",
              .sentence = "Instead of a file: plane, box, sphere, relief or v_groove, centred at the origin, "
                          "its picture side towards +z."},
        mesh.shape);
  visit(
      Field{
          .key = "board",
          .sentence =
              "Instead of a file: a printed calibration board, centred at the origin, its print towards +z: "
              "chessboard,9x7,75mm or charuco,8x6,40mm,30mm,DICT_4X4_50 or circles,7x5,30mm,15mm or "
              "acircles,4x11,20mm,15mm (sim/printed_board.h). Its ink reflects a twentieth of `albedo`."},
      mesh.board);
  visit(Field{.key = "shape_size",
              .unit = "m",
              .sentence = "Size of the shape along x, y and z; a sphere's diameter three times.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        mesh.shape_size);
  visit(Field{.key = "detail",
              .sentence = "Columns and rows of a plane or relief, subdivisions of a sphere.",
              .low = 1,
              .high = 4096},
        mesh.detail);
  visit(Field{.key = "seed", .sentence = "Draws the relief's bumps and the solid noise.", .low = 0},
        mesh.seed);
  visit(Field{.key = "unit", .sentence = "The unit of the file's coordinates: m, mm, cm, km, inch or foot."},
        mesh.unit);
  visit(
      Field{.key = "up",
            .sentence = "The file's axis that points up. \"z\": coordinates as they stand. \"y\": the file's "
                        "(x, y, z) becomes (x, -z, y)."},
      mesh.up);
  visit(Field{.key = "world_from_object",
              .unit = "m",
              .sentence = "3×4 rows [A, t] of any affine map that is not singular, after `unit` and `up`. "
                          "Absent: scale, rotate_deg and translate.",
              .low = -farthest_m,
              .high = farthest_m},
        mesh.world_from_object);
  visit(Field{.key = "scale",
              .sentence = "Enlarges the mesh about its origin, after `unit` and `up`.",
              .low = 0,
              .high = farthest_m,
              .low_excluded = true},
        mesh.scale);
  visit(Field{.key = "rotate_deg",
              .unit = "deg",
              .sentence = "Then turns it about the world's x axis, then y, then z (counter-clockwise as seen "
                          "from the axis's tip).",
              .low = -36000,
              .high = 36000},
        mesh.rotate_deg);
  visit(Field{.key = "translate",
              .unit = "m",
              .sentence = "Then moves it.",
              .low = -farthest_m,
              .high = farthest_m},
        mesh.translate);
  visit(Field{.key = "albedo", .sentence = "Reflected over incident light.", .low = 0, .high = 1},
        mesh.albedo);
  visit(Field{.key = "albedo_map",
              .sentence = "A picture that multiplies `albedo`, through the mesh's texture coordinates; "
                          "relative to the scene file."},
        mesh.albedo_map);
  visit(Field{.key = "albedo_map_encoding",
              .sentence = "What the integers of an 8- or 16-bit picture mean; float pictures are linear."},
        mesh.albedo_map_encoding);
  describe(visit, mesh.effects);
  visit(
      Field{.key = "believed",
            .sentence = "What the solver is told of this mesh, where that is not the truth: `roundtrip` and "
                        "`calibrate` take their points from it."},
      mesh.believed);
}

}  // namespace laterna
