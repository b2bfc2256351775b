#include "sim/mesh_file.h"

#include "sim/ply.h"
#include "tests/sim/surface.h"
#include "tests/testing.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include <fstream>
#include <limits>
#include <sstream>

namespace laterna {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;
using ::testing::StartsWith;
using testing::write_text;

const std::filesystem::path house = "/usr/share/assimp/models/IFC/AC14-FZK-Haus.ifc";

std::string refusal(const std::filesystem::path& path) {
  return input_error([&] { read_mesh(path); });
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::filesystem::path write_gzip(const std::filesystem::path& path, const std::string& text) {
  gzFile file = gzopen(path.c_str(), "wb");
  EXPECT_EQ(gzwrite(file, text.data(), unsigned(text.size())), int(text.size()));
  gzclose(file);
  return path;
}

glm::dvec3 front_of_first_triangle(const Mesh& mesh) {
  return glm::normalize(testing::area_vector(mesh, mesh.triangles.at(0)));
}

/// A quad in the plane z = 3, front to +z, and a line, which is no surface.
const std::string quad_obj =
    "v 0 0 3\nv 2 0 3\nv 2 1 3\nv 0 1 3\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nl 1 3\n";

/// The same plane as a triangle, declared in `stated`: what the file says of its axes and unit.
std::string triangle_dae(const std::string& stated) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\">"
         "<asset>" +
         stated +
         "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
         "<float_array id=\"a\" count=\"9\">0 0 3 2 0 3 0 1 3</float_array><technique_common>"
         "<accessor source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
         "<param name=\"Y\" type=\"float\"/><param name=\"Z\" "
         "type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\">"
         "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
         "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

/// The same triangle under a node `transform`, with its 36 bytes of positions in a file beside it.
std::filesystem::path write_triangle_gltf(const ScratchFolder& folder, const std::string& transform) {
  std::string buffer;
  for (const float value : {0.F, 0.F, 3.F, 2.F, 0.F, 3.F, 0.F, 1.F, 3.F})
    buffer.append(reinterpret_cast<const char*>(&value), sizeof(value));
  write_text(folder / "triangle.bin", buffer);
  return write_text(folder / "triangle.gltf",
                    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
                        transform +
                        R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,3],"max":[2,1,3]}],
          "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"triangle.bin"}]})");
}

TEST(MeshFile, ReadsPlyAlsoPackedAndInCapitals) {
  const ScratchFolder folder;
  const std::string cube = text_of(laterna::testing::data_folder() / "meshes/cube.ply");
  for (const auto& path :
       {write_text(folder / "cube.ply", cube), write_text(folder / "CUBE.PLY", cube),
        write_gzip(folder / "cube.ply.gz", cube), write_gzip(folder / "cube.Ply.GZ", cube)}) {
    const Mesh mesh = read_mesh(path);
    EXPECT_EQ(testing::open_edges(mesh), 0) << path;
    EXPECT_EQ(testing::volume(mesh), 1.0) << path;  // halves and integers: exact
    EXPECT_TRUE(testing::pictures_unmirrored(mesh)) << path;
  }
}

TEST(MeshFile, ReadsObjAsItStands) {
  const ScratchFolder folder;
  for (const auto& path :
       {write_text(folder / "a.obj", quad_obj), write_gzip(folder / "a.obj.gz", quad_obj)}) {
    const Mesh mesh = read_mesh(path);
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(bounds(mesh).low, glm::dvec3(0, 0, 3));
    EXPECT_EQ(bounds(mesh).high, glm::dvec3(2, 1, 3));
    EXPECT_EQ(front_of_first_triangle(mesh), glm::dvec3(0, 0, 1));
  }
}

TEST(MeshFile, TextureCoordinatesPointUp) {
  const ScratchFolder folder;
  const Mesh mesh = read_mesh(write_text(folder / "a.obj", quad_obj.substr(0, quad_obj.find("l 1"))));
  ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_EQ(mesh.texture_coordinates[i], glm::dvec2(mesh.positions[i].x / 2, mesh.positions[i].y));
}

TEST(MeshFile, TextureCoordinatesNeedEveryPart) {
  const ScratchFolder folder;
  const std::string bare_part = "o other\nv 0 0 4\nv 1 0 4\nv 0 1 4\nf 5 6 7\n";
  const Mesh mesh =
      read_mesh(write_text(folder / "a.obj", quad_obj.substr(0, quad_obj.find("l 1")) + bare_part));
  EXPECT_EQ(mesh.triangles.size(), 3U);
  EXPECT_TRUE(mesh.texture_coordinates.empty());
}

TEST(MeshFile, ReadsStlAsItStands) {
  const ScratchFolder folder;
  const Mesh mesh = read_mesh(write_text(
      folder / "a.stl",
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 3\nvertex 2 0 3\nvertex 0 1 3\nendloop\nendfacet\n"
      "endsolid a\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(bounds(mesh).high, glm::dvec3(2, 1, 3));
  EXPECT_EQ(front_of_first_triangle(mesh), glm::dvec3(0, 0, 1));
}

TEST(MeshFile, ReadsOffAsItStands) {
  const ScratchFolder folder;
  const Mesh mesh = read_mesh(write_text(folder / "a.off", "OFF\n3 1 0\n0 0 3\n2 0 3\n0 1 3\n3 0 1 2\n"));
  EXPECT_EQ(bounds(mesh).high, glm::dvec3(2, 1, 3));
  EXPECT_EQ(front_of_first_triangle(mesh), glm::dvec3(0, 0, 1));
}

TEST(MeshFile, ReadsGltfWithItsNodeTransforms) {
  const ScratchFolder folder;
  const Mesh plain = read_mesh(write_triangle_gltf(folder, ""));
  EXPECT_EQ(bounds(plain).high, glm::dvec3(2, 1, 3));
  EXPECT_EQ(front_of_first_triangle(plain), glm::dvec3(0, 0, 1));
  const Mesh moved = read_mesh(write_triangle_gltf(folder, R"(,"translation":[10,0,0],"scale":[2,2,2])"));
  EXPECT_EQ(bounds(moved).low, glm::dvec3(10, 0, 6));
  EXPECT_EQ(bounds(moved).high, glm::dvec3(14, 2, 6));
}

TEST(MeshFile, AMirroringNodeKeepsTheFrontOutside) {
  const ScratchFolder folder;
  const Mesh mesh = read_mesh(write_triangle_gltf(folder, R"(,"scale":[1,1,-1])"));
  EXPECT_EQ(bounds(mesh).high, glm::dvec3(2, 1, -3));
  EXPECT_EQ(front_of_first_triangle(mesh), glm::dvec3(0, 0, -1));  // a front to +z, mirrored in z
}

TEST(MeshFile, ReadsColladaInItsOwnAxesAndMetres) {
  const ScratchFolder folder;
  for (const std::string axis : {"X_UP", "Y_UP", "Z_UP"}) {
    const Mesh mesh = read_mesh(
        write_text(folder / (axis + ".dae"),
                   triangle_dae("<unit name=\"two\" meter=\"2\"/><up_axis>" + axis + "</up_axis>")));
    EXPECT_EQ(bounds(mesh).low, glm::dvec3(0, 0, 6)) << axis;
    EXPECT_EQ(bounds(mesh).high, glm::dvec3(4, 2, 6)) << axis;
  }
}

TEST(MeshFile, ReadsDxfInItsOwnAxes) {
  const ScratchFolder folder;
  const Mesh mesh =
      read_mesh(write_text(folder / "a.dxf",
                           "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\n0\n10\n0\n20\n0\n30\n3\n11\n2\n21\n0\n"
                           "31\n3\n12\n0\n22\n1\n32\n3\n13\n0\n23\n1\n33\n3\n0\nENDSEC\n0\nEOF\n"));
  EXPECT_EQ(bounds(mesh).low, glm::dvec3(0, 0, 3));
  EXPECT_EQ(bounds(mesh).high, glm::dvec3(2, 1, 3));
}

TEST(MeshFile, ReadsTheIfcHouseWithZUpInMetres) {
  if (!std::filesystem::exists(house)) GTEST_SKIP() << house << " is not there (Debian's assimp-testmodels)";
  const Mesh mesh = read_mesh(house);
  EXPECT_EQ(mesh.triangles.size(), 35906U);
  const Box box = bounds(mesh);
  // The terrain is the file's slab from (-3, -3, -1) to (15, 13, 0). Float coordinates below 16: 1e-6.
  EXPECT_LT(glm::length(box.low - glm::dvec3(-3, -3, -1)), 2e-6);
  EXPECT_LT(glm::length(glm::dvec2(box.high) - glm::dvec2(15, 13)), 2e-6);
  EXPECT_NEAR(box.high.z, 6.31769, 1e-5);  // the ridge, as printed by Assimp with six digits
}

TEST(MeshFile, ReadsAnIfcFileInItsUnit) {
  if (!std::filesystem::exists(house)) GTEST_SKIP() << house << " is not there (Debian's assimp-testmodels)";
  const ScratchFolder folder;
  std::string text = text_of(house);
  const std::string metre = ".LENGTHUNIT.,$,.METRE.";
  text.replace(text.find(metre), metre.size(), ".LENGTHUNIT.,.MILLI.,.METRE.");
  const Box box = bounds(read_mesh(write_text(folder / "mm.ifc", text)));
  EXPECT_LT(glm::length(box.low - glm::dvec3(-3e-3, -3e-3, -1e-3)),
            2e-9);  // as above, a thousand times smaller
}

TEST(MeshFile, RefusesAnIfcFileCutShort) {
  if (!std::filesystem::exists(house)) GTEST_SKIP() << house << " is not there (Debian's assimp-testmodels)";
  const ScratchFolder folder;
  const auto path = write_text(folder / "cut.ifc", text_of(house).substr(0, 2000000));
  EXPECT_EQ(refusal(path),
            path.string() + ": does not end with `END-ISO-10303-21;`: the file is truncated or no IFC file");
}

TEST(MeshFile, RefusesPathsThatAreNoMeshFile) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder / "none.ply"), (folder / "none.ply").string() + ": there is no such file");
  EXPECT_THAT(refusal(write_text(folder / "a.xyzzy", "1")),
              HasSubstr("the ending `.xyzzy` is no mesh format"));
  EXPECT_THAT(refusal(write_text(folder / "plain", "1")), HasSubstr("the ending `` is no mesh format"));
  EXPECT_THAT(refusal(write_text(folder / "a.gz", "1")), HasSubstr("the ending `` is no mesh format"));
  EXPECT_EQ(refusal(write_text(folder / "a.obj", "")), (folder / "a.obj").string() + ": the file is empty");
  std::filesystem::create_directory(folder / "folder.ply");
  EXPECT_EQ(refusal(folder / "folder.ply"),
            (folder / "folder.ply").string() + ": is a folder, expected a mesh file");
  EXPECT_EQ(refusal("/dev/null/a.ply"), "/dev/null/a.ply: there is no such file");
}

TEST(MeshFile, RefusesBrokenMeshes) {
  const ScratchFolder folder;
  const auto is_refused = [&](const char* name, const std::string& content, const std::string& reason) {
    EXPECT_THAT(refusal(write_text(folder / name, content)),
                ::testing::AllOf(StartsWith((folder / name).string() + ": "), HasSubstr(reason)));
  };
  is_refused("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", "the mesh has no triangles");
  is_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "each of its 1 triangles has zero area");
  is_refused("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "holds nan, expected finite coordinates");
  is_refused("junk.glb", "this is no glTF", "cannot be read as .glb: ");
  is_refused("junk.ply.gz", "this is no gzip stream", "the gzip stream is corrupt");
  is_refused("range.off", "OFF\n3 1 0\n0 0 3\n2 0 3\n0 1 3\n3 0 1 7\n", "OFF: Vertex index is out of range");
  is_refused("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "vertex index out of range");
  is_refused("cut.stl",
             "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 3\nvertex 2 0 3\nvertex 0 1 "
             "3\nendloop\nendfacet\n",
             "unexpected EOF");
  is_refused("empty.ply", ply_bytes({{{0, 0, 0}}, {}, {}}), "the mesh has no triangles");
}

TEST(MeshFile, ACrashOfAssimpIsASentence) {
  const ScratchFolder folder;
  const auto path =
      write_text(folder / "a.off", std::string("3 4\n0\0001 ", 8));  // fails an assertion of Assimp 5.2
  EXPECT_THAT(refusal(path),
              AllOf(StartsWith(path.string()), HasSubstr("Assimp's .off reader crashes on it (signal 6)")));
}

TEST(MeshFile, AskingForAllMemoryIsASentence) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "skipped: AddressSanitizer ends the reader before its limit does";
#endif
  const ScratchFolder folder;
  const auto path = write_text(folder / "a.off", "OFF\n4000000000 1 0\n0 0 3\n");
  EXPECT_THAT(refusal(path), HasSubstr("Assimp's .off reader asks for more memory than"));
}

TEST(MeshFile, MetresPerUnit) {
  EXPECT_EQ(metres_per_unit("m"), 1.0);
  EXPECT_EQ(metres_per_unit("mm"), 0.001);
  EXPECT_EQ(metres_per_unit("cm"), 0.01);
  EXPECT_EQ(metres_per_unit("km"), 1000.0);
  EXPECT_EQ(metres_per_unit("inch"), 0.0254);
  EXPECT_EQ(metres_per_unit("foot"), 0.3048);
  EXPECT_EQ(input_error([] { metres_per_unit("mile"); }),
            "unit \"mile\" is not known, expected one of \"m\", \"mm\", \"cm\", \"km\", \"inch\", \"foot\"");
}

}  // namespace
}  // namespace laterna
