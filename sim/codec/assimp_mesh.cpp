#include "sim/codec/assimp_mesh.h"

#include "sim/error.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <new>
#include <string_view>

namespace laterna {

namespace {

/// GLM stores columns, Assimp rows.
glm::dmat4 matrix_of(const aiMatrix4x4& m) {
  return glm::transpose(glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,  //
                                   m.d1, m.d2, m.d3, m.d4));
}

/// What takes back the turn from z up to y up that Assimp's importers of these formats put in front of the
/// root. For IFC the turn is a float rotation by -90°, whose cosine is -4e-8: its own inverse in double takes
/// that out too.
glm::dmat4 file_from_assimp(const std::string& extension) {
  if (extension == ".ifc") {
    aiMatrix4x4 turn;
    aiMatrix4x4::RotationX(-1.57079632679489661923F, turn);
    return glm::inverse(matrix_of(turn));
  }
  const std::string_view turned[] = {".3ds", ".dxf", ".ase", ".md2"};
  if (std::find(std::begin(turned), std::end(turned), extension) == std::end(turned)) return glm::dmat4(1.0);
  return {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}};  // columns: file x, y, z = x, -z', y'
}

/// Assimp's own triangulation trusts the indices, so they are checked before it runs.
void expect_indices_in_range(const aiScene& scene, const std::string& name) {
  for (unsigned part = 0; part < scene.mNumMeshes; ++part) {
    const aiMesh& mesh = *scene.mMeshes[part];
    for (unsigned face = 0; face < mesh.mNumFaces; ++face) {
      for (unsigned k = 0; k < mesh.mFaces[face].mNumIndices; ++k) {
        const unsigned index = mesh.mFaces[face].mIndices[k];
        if (index < mesh.mNumVertices) continue;
        throw InputError(fmt::format("{}: face {} of part {} uses vertex {}, but the part has {} vertices",
                                     name, face, part, index, mesh.mNumVertices));
      }
    }
  }
}

void append_part(const aiMesh& part, const glm::dmat4& file_from_part, const std::string& name, Mesh& mesh) {
  const std::size_t first = mesh.positions.size();
  if (first + part.mNumVertices > std::numeric_limits<std::uint32_t>::max())
    throw InputError(name + ": more than 4294967295 vertices");
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh.positions.emplace_back(file_from_part * glm::dvec4(p.x, p.y, p.z, 1.0));
    if (!part.HasTextureCoords(0)) continue;
    mesh.texture_coordinates.emplace_back(part.mTextureCoords[0][i].x, part.mTextureCoords[0][i].y);
  }
  const bool mirrored = glm::determinant(glm::dmat3(file_from_part)) < 0;
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    if (part.mFaces[i].mNumIndices != 3) continue;  // points and lines
    const unsigned* corner = part.mFaces[i].mIndices;
    glm::uvec3 triangle(corner[0], corner[1], corner[2]);
    if (mirrored) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle + unsigned(first));
  }
}

/// All parts of all nodes, each under the product of the nodes above it.
Mesh merge(const aiScene& scene, const glm::dmat4& file_from_root, const std::string& name) {
  Mesh mesh;
  std::vector<std::pair<const aiNode*, glm::dmat4>> open = {{scene.mRootNode, file_from_root}};
  while (!open.empty()) {
    const auto [node, file_from_parent] = open.back();
    open.pop_back();
    const glm::dmat4 file_from_node = file_from_parent * matrix_of(node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      append_part(*scene.mMeshes[node->mMeshes[i]], file_from_node, name, mesh);
    for (unsigned i = node->mNumChildren; i > 0; --i)
      open.emplace_back(node->mChildren[i - 1], file_from_node);
  }
  if (mesh.texture_coordinates.size() != mesh.positions.size()) mesh.texture_coordinates.clear();
  return mesh;
}

/// Keeps the first complaint of Assimp's log that tells of damage which Assimp repairs by guessing: an index
/// out of range (OFF: clamped) or an early end (ascii STL, IFC).
class DamageLog : public Assimp::LogStream {
 public:
  void write(const char* message) override {
    const std::string_view text(message);
    const bool is_damage = text.find("out of range") != text.npos || text.find("unexpected EOF") != text.npos;
    if (is_damage && complaint.empty()) complaint = text.substr(0, text.find('\n'));
  }
  std::string complaint;
};

/// Attaches a log stream while it lives. Assimp has one logger for the whole program, so one reader at a
/// time.
class Listening {
 public:
  explicit Listening(Assimp::LogStream& stream) : lock_(mutex()), stream_(stream) {
    if (owns_logger_) Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(&stream_, severity);
  }
  ~Listening() {
    Assimp::DefaultLogger::get()->detachStream(&stream_, severity);
    if (owns_logger_) Assimp::DefaultLogger::kill();
  }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

 private:
  static constexpr unsigned severity = Assimp::Logger::Err | Assimp::Logger::Warn;
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
  Assimp::LogStream& stream_;
  bool owns_logger_ = Assimp::DefaultLogger::isNullLogger();
};

using Read = std::function<const aiScene*(Assimp::Importer&)>;

Mesh read_scene(const Read& read, const std::string& extension, const std::string& name) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  DamageLog damage;
  const Listening listening(damage);
  const aiScene* scene = read(importer);
  if (!scene || !scene->mRootNode) {
    std::string reason = importer.GetErrorString();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    if (reason.find("bad_alloc") != reason.npos)
      throw std::bad_alloc();  // Assimp catches it and keeps the name
    throw InputError(fmt::format("{}: cannot be read as {}: {}", name, extension, reason));
  }
  if (!damage.complaint.empty())
    throw InputError(
        fmt::format("{}: the file is damaged, its {} reader says: {}", name, extension, damage.complaint));
  expect_indices_in_range(*scene, name);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene)
    throw InputError(fmt::format("{}: cannot be triangulated: {}", name, importer.GetErrorString()));
  return merge(*scene, file_from_assimp(extension), name);
}

}  // namespace

bool assimp_reads(const std::string& extension) {
  return extension.size() > 1 && Assimp::Importer().IsExtensionSupported(extension);
}

Mesh read_with_assimp(const std::filesystem::path& path, const std::string& extension) {
  const Read read = [&](Assimp::Importer& importer) { return importer.ReadFile(path.string(), 0); };
  return read_scene(read, extension, path.string());
}

Mesh read_with_assimp(std::string_view bytes, const std::string& extension, const std::string& name) {
  const std::string hint = extension.substr(1);
  const Read read = [&](Assimp::Importer& importer) {
    return importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, hint.c_str());
  };
  return read_scene(read, extension, name);
}

}  // namespace laterna
