#include "cguide/numeric/io/mesh_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <map>
#include <unordered_map>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/mesh_reader_guard_internal.h"
#include "cguide/numeric/io/urdf_xml_internal.h"

namespace cguide::numeric::io {
namespace {

constexpr std::uintmax_t kLargestFile = 512u << 20;
constexpr std::size_t kMostTriangles = 5'000'000;

[[noreturn]] void Refuse(const std::string& place, const std::string& what) {
  throw Error(Error::Code::kBadInput, place + ": " + what);
}

MeshFormat FormatOf(const std::filesystem::path& file) {
  static const std::map<std::string, MeshFormat> kFormats = {{".stl", MeshFormat::kStl},
                                                             {".obj", MeshFormat::kObj},
                                                             {".dae", MeshFormat::kDae},
                                                             {".off", MeshFormat::kOff}};
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = kFormats.find(extension);
  if (found == kFormats.end()) {
    Refuse(file.string(),
           "unknown mesh format \"" + extension + "\"; convert it to STL, OBJ, DAE or OFF");
  }
  return found->second;
}

// Equal points are one vertex; -0 equals 0, which adding 0 makes true of the bits as well.
class VertexMerger {
 public:
  explicit VertexMerger(std::vector<Eigen::Vector3d>* vertices) : vertices_(*vertices) {}
  int Index(const Eigen::Vector3d& v) {
    const auto [found, added] = index_.emplace(Key{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0},
                                               static_cast<int>(vertices_.size()));
    if (added) vertices_.emplace_back(found->first[0], found->first[1], found->first[2]);
    return found->second;
  }

 private:
  using Key = std::array<double, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::size_t hash = 0;
      for (double x : key) hash = hash * 1000003 + std::hash<double>()(x);
      return hash;
    }
  };
  std::vector<Eigen::Vector3d>& vertices_;
  std::unordered_map<Key, int, Hash> index_;
};

// Adds the importer's triangles, its floats times the scale in doubles.
class Collector {
 public:
  Collector(const Eigen::Vector3d& scale, const std::string& place, TriangleMesh* mesh)
      : scale_(scale),
        flip_(scale.prod() < 0),
        place_(place),
        mesh_(*mesh),
        merger_(&mesh->vertices) {}

  void Add(const aiMesh& source) {
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines bound no matter
      if (mesh_.triangles.size() == kMostTriangles) {
        Refuse(place_, "more than 5 million triangles; simplify the mesh");
      }
      std::array<int, 3> triangle;
      for (int c = 0; c < 3; ++c) {
        const unsigned index = face.mIndices[flip_ ? 2 - c : c];
        if (index >= source.mNumVertices) {
          Refuse(place_, "a triangle names a vertex that does not exist");
        }
        triangle[c] = AddVertex(source.mVertices[index]);
      }
      mesh_.triangles.push_back(triangle);
    }
  }

 private:
  int AddVertex(const aiVector3D& vertex) {
    const Eigen::Vector3d v = Eigen::Vector3d(vertex.x, vertex.y, vertex.z).cwiseProduct(scale_);
    if (!v.allFinite()) Refuse(place_, "a coordinate is NaN or infinite");
    if (v.cwiseAbs().maxCoeff() > kLargestNumber) {
      Refuse(place_, "a coordinate exceeds 1e6 m; check the units and the scale");
    }
    return merger_.Index(v);
  }

  const Eigen::Vector3d scale_;
  const bool flip_;
  const std::string& place_;
  TriangleMesh& mesh_;
  VertexMerger merger_;
};

}  // namespace

TriangleMesh ReadMesh(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  const std::string place = file.string();
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    Refuse(place, "the mesh scale must be three finite factors other than zero");
  }
  const MeshFormat format = FormatOf(file);
  const GuardedMesh guarded = GuardMesh(ReadBytes(file, kLargestFile), format, place);
  TriangleMesh mesh;
  try {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(guarded.bytes.data(), guarded.bytes.size(),
                                                       aiProcess_Triangulate, guarded.hint);
    if (scene == nullptr) {
      Refuse(place, std::string("cannot be read as a mesh (") + importer.GetErrorString() +
                        "); the file may be damaged");
    }
    // The formats that reach the importer have no transforms: each mesh of the scene stands once.
    Collector collector(scale, place, &mesh);
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) collector.Add(*scene->mMeshes[i]);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    Refuse(place,
           std::string("cannot be read as a mesh (") + error.what() + "); the file may be damaged");
  }
  if (mesh.triangles.empty()) Refuse(place, "the mesh has no triangle");
  return mesh;
}

}  // namespace cguide::numeric::io
