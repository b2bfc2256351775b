// Mesh files of any format.
#pragma once

#include "sim/mesh.h"

#include <filesystem>
#include <string>

namespace laterna {

/// Reads and validates a mesh file. The ending of its name, in capital or small letters, tells the format; a
/// further `.gz` is unpacked first. `.ply` is read by read_ply, all others by the Assimp library in a process
/// of its own with limits (laterna-mesh-reader): 1 GiB of memory and 20 s, and 64 bytes and 10 µs more for
/// each byte of the file.
///
/// **Axes and units: coordinates as they stand in the file.** No format is turned to another up axis. So z is
/// up where the file's author had z up (IFC, most STL and PLY scans of buildings), and y where the format or
/// the author says y (glTF always, most OBJ); a scene turns a mesh by its world_from_object. Only the unit
/// that a file itself declares is applied:
///
/// | format | axes | unit of the result |
/// |---|---|---|
/// | PLY, OBJ, STL, OFF, 3MF, AMF, X3D, BLEND | as in the file | as in the file |
/// | IFC | as in the file: z up, in the project's coordinate system | metres, from the file's length unit |
/// | glTF, GLB | as in the file: y up | metres, by its standard |
/// | COLLADA | as in the file, whatever `up_axis` says | metres, from the file's `unit` |
/// | FBX | as in the file, whatever `UpAxis` says | as in the file, whatever `UnitScaleFactor` says |
/// | 3DS, ASE, DXF, MD2 | as in the file: z up | as in the file |
///
/// Assimp turns IFC, 3DS, ASE, DXF and MD2 from z up to y up; this is taken back here. Further formats that
/// Assimp knows are read too, in the axes that it gives them.
///
/// Node transforms are applied in double and all parts merged into one mesh; a mirroring transform keeps the
/// front sides. Polygons are triangulated, points and lines dropped, skins and animations left at rest.
/// Texture coordinates are those of channel 0 where every part has them, else none. Assimp holds coordinates
/// as floats: 24 bits, some 1e-7 of the distance from the origin of each part. PLY has no such loss.
///
/// Throws InputError, beginning with the path, where there is no such file, it cannot be read, its ending is
/// not known, its gzip stream is broken, its reader refuses it, crashes on it, exceeds its limits or warns of
/// an early end or of an index out of range, an IFC file lacks its last line, or validate() refuses the mesh.
/// An OBJ file that was cut short between two lines cannot be told from a whole one.
Mesh read_mesh(const std::filesystem::path& path);

/// Metres in one `unit`: "m", "mm", "cm", "km", "inch" (0.0254) or "foot" (0.3048, the international one).
/// Throws InputError, listing these, for another.
double metres_per_unit(const std::string& unit);

}  // namespace laterna
