// From what a scene file says to a scene that can be rendered.
#pragma once

#include "sim/scene.h"
#include "sim/scene_spec.h"

#include <filesystem>

namespace laterna {

/// What a single entry says, checked as far as can be without opening another file: exclusive and missing
/// keys, units, matrices, intrinsics, lens, light planes. Throws InputError, beginning with the entry's
/// heading and name: `[[projector]] "left": ...`.
void check(const MeshSpec& mesh);
void check(const ProjectorSpec& projector);
void check(const CameraSpec& camera);
void check(const ColourSpec& colour);

/// What concerns the scene as a whole: at least one mesh, no name that two devices share, none that
/// [[colour]] or [timing] knows alone, and what the effects need (sim/effect_checks.h). A scene without
/// projector or camera is sound; the commands that need one say so.
void check(const SceneSpec& scene);

/// `world_from_object · U · unit` of a mesh, as its specification defines it: from coordinates of the file to
/// the world. Throws InputError where both world_from_object and scale, rotate_deg or translate are given, or
/// where the map is singular.
glm::dmat4 world_from_file(const MeshSpec& mesh);

/// The scene, validated, with files looked for in `folder`. The meshes stand as their files hold them:
/// Object::world_from_object is world_from_file(). Throws InputError as check() does, and where a file is not
/// there, unreadable or unsound, a vertex lies farther out than farthest_m, or a mesh with an albedo map has
/// no texture coordinates.
Scene build_scene(const SceneSpec& spec, const std::filesystem::path& folder);

/// The names of devices with the defaults filled in: "projector", or "projector1", "projector2", ...; cameras
/// likewise. Mesh names: of the file without its endings, or of the shape.
SceneSpec with_names(SceneSpec spec);

}  // namespace laterna
