// PLY files, read strictly and in double precision.
#pragma once

#include "sim/mesh.h"

#include <string>
#include <string_view>

namespace laterna {

/// Reads a whole PLY file, given as bytes: ascii, binary_little_endian or binary_big_endian. `name` begins
/// each message.
///
/// - Positions are `x`, `y`, `z` of element `vertex`, as they stand in the file: no axis turned, no unit
/// changed.
///   Text is read to the nearest double, also where the header says float.
/// - Texture coordinates are `s`,`t`, else `u`,`v`, else `texture_u`,`texture_v` of element `vertex`, else
/// none.
///   Coordinates kept per face (`texcoord`) are not read.
/// - Triangles are `vertex_indices` or `vertex_index` of element `face`. A polygon becomes a fan around its
/// first
///   corner, which is right for convex ones.
/// - All other properties and elements are passed over.
///
/// The header's counts are held against the number of bytes before memory is asked for. In text, each record
/// stands on a line of its own; empty lines are passed over.
///
/// Throws InputError, naming the line (text) or the record (binary), for: a bad header; too few or too many
/// bytes or values; a word that is no number, or no number of its type; nan or infinity; a face with fewer
/// than three corners; an index outside the vertices; no vertex or no face element. What the mesh is as a
/// surface is left to validate().
Mesh read_ply(std::string_view bytes, const std::string& name);

/// The mesh as a binary little-endian PLY file: x, y, z and, where there are texture coordinates, s, t as
/// doubles; triangles as lists of uchar and uint. read_ply gives the same bits back. The mesh is expected to
/// be validated.
std::string ply_bytes(const Mesh& mesh);

}  // namespace laterna
