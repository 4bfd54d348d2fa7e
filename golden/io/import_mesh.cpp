#include "golden/io/import_mesh.hpp"

#include "golden/io/error.hpp"
#include "golden/io/gltf_json.hpp"
#include "golden/io/merge_pairs.hpp"
#include "golden/io/mesh_format.hpp"
#include "golden/io/text_input.hpp"

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <string_view>
#include <vector>

namespace quadrille::golden {
namespace {

/// What assimp logs while it reads; it has one logger for all threads.
class Log {
 public:
  Log() : lock_(mutex_) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Lines(errors), Assimp::Logger::Err);
    Assimp::DefaultLogger::get()->attachStream(new Lines(warnings), Assimp::Logger::Warn);
  }
  ~Log() { Assimp::DefaultLogger::kill(); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  std::vector<std::string> errors, warnings;

 private:
  struct Lines : Assimp::LogStream {  // the logger's, which deletes it
    explicit Lines(std::vector<std::string>& to) : lines(to) {}
    void write(const char* message) override {  // "Error, T0: what\n"
      std::string text = message;
      if (const std::size_t head = text.find(": "); head != std::string::npos) text.erase(0, head + 2);
      while (!text.empty() && text.back() == '\n') text.pop_back();
      lines.push_back(printable(text));
    }
    std::vector<std::string>& lines;
  };

  static inline std::mutex mutex_;
  std::lock_guard<std::mutex> lock_;
};

/// assimp never comes back from a PLY header that does not end, and believes any count.
void check_ply_header(std::string_view text, const std::string& path) {
  constexpr std::array<std::string_view, 6> known{"ply", "format", "comment", "obj_info", "element", "property"};
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    TokenLines lines(text.substr(at, end - at), TokenLines::Continuation::none);
    std::vector<Token> tokens;
    lines.next(tokens);
    at = end + (text.substr(end).starts_with("\r\n") ? 2 : 1);
    const std::string_view word = tokens.empty() ? std::string_view() : tokens.front().text;
    if (word == "end_header" && end < text.size()) return;
    if (word == "end_header") break;
    if (std::ranges::find(known, word) == known.end())
      throw input_error(path, line,
                        "the header has " + in_quotes(word) + "; comment, element, property, … and at last " +
                            "end_header are expected");
    if (word != "element") continue;
    const Number count = parse_number(tokens.size() == 3 ? tokens[2].text : std::string_view());
    if (!count.problem.empty() || count.value < 0 || count.value > static_cast<double>(text.size()))
      throw input_error(path, line,
                        "an element needs a name and a count that the file has room for, such as \"element "
                        "vertex 8\"");
  }
  throw input_error(path, 0, "is cut off in its header; a line end_header is expected");
}

class Importer {
 public:
  explicit Importer(const std::string& path) : path_(path), format_(format_of_mesh(path)) {}

  Mesh run(bool pairs) {
    const std::string text = read_file(path_, "a mesh in " + std::string(name_of(format_)));
    if (text.empty()) throw failure("the file is empty; a mesh in " + std::string(name_of(format_)) + " is expected");
    if (format_ == MeshFormat::ply) check_ply_header(text, path_);
    if (format_ == MeshFormat::gltf) ngons_ = ngon_primitives(text, path_);
    {
      Log log;
      // glTF names other files.
      const aiScene* scene =
          format_ == MeshFormat::gltf
              ? importer_.ReadFile(path_, aiProcess_ValidateDataStructure)
              : importer_.ReadFileFromMemory(text.data(), text.size(), aiProcess_ValidateDataStructure,
                                             format_ == MeshFormat::ply ? "ply" : "off");
      check(log, scene);
      scene_ = scene;
    }
    if (!ngons_.empty() && ngons_.size() != scene_->mNumMeshes) throw failure("its primitives cannot be told apart");
    node(*scene_->mRootNode, aiMatrix4x4t<double>());
    if (mesh_.faces.empty()) throw failure("no face was found; a mesh with at least one polygon is expected");
    if (!coloured_) mesh_.colours.clear();
    note_counts(pairs);
    if (pairs) merge_pairs(mesh_);
    return std::move(mesh_);
  }

 private:
  InputError failure(const std::string& what) const { return input_error(path_, 0, what); }

  void check(const Log& log, const aiScene* scene) {
    const auto refused = [&](const std::string& what) {
      return failure("assimp says: " + what + "; a complete mesh in " + std::string(name_of(format_)) + " is expected");
    };
    if (!log.errors.empty()) throw refused(log.errors.front());
    if (scene == nullptr || scene->mRootNode == nullptr) throw refused(printable(importer_.GetErrorString()));
    for (const std::string& warning : log.warnings) {
      for (const char* lost : {"dropped", "Skipping"})
        if (warning.find(lost) != std::string::npos) throw refused(warning);
      if (!warning.starts_with("Validation warning")) mesh_.notes.push_back("assimp says: " + warning);
    }
  }

  void node(const aiNode& at, const aiMatrix4x4t<double>& above) {
    const aiMatrix4x4& m = at.mTransformation;
    const aiMatrix4x4t<double> here = above * aiMatrix4x4t<double>(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1,
                                                                   m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4);
    for (unsigned i = 0; i < at.mNumMeshes; ++i) mesh(at.mMeshes[i], here);
    for (unsigned i = 0; i < at.mNumChildren; ++i) node(*at.mChildren[i], here);
  }

  /// One use of a mesh, with its vertices where the node puts them.
  void mesh(unsigned index, const aiMatrix4x4t<double>& m) {
    const aiMesh& mesh = *scene_->mMeshes[index];
    const std::size_t first = mesh_.positions.size();
    if (first + mesh.mNumVertices > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw failure("more than 2^31 vertices");
    const aiColor4D factor = base_colour(mesh);
    coloured_ = coloured_ || mesh.HasVertexColors(0) || factor.r != 1 || factor.g != 1 || factor.b != 1;
    const bool placed = m != aiMatrix4x4t<double>();
    // Normals go by the cofactors, which a mirror turns inside out.
    const aiMatrix3x3t<double> part(m);
    const double sign = part.Determinant() < 0 ? -1 : 1;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const auto& p = mesh.mVertices[i];
      const Vec3 at{double{p.x}, double{p.y}, double{p.z}};
      mesh_.positions.push_back(placed ? Vec3{m.a1 * at[0] + m.a2 * at[1] + m.a3 * at[2] + m.a4,
                                              m.b1 * at[0] + m.b2 * at[1] + m.b3 * at[2] + m.b4,
                                              m.c1 * at[0] + m.c2 * at[1] + m.c3 * at[2] + m.c4}
                                       : at);
      check_numbers("position", i, mesh_.positions.back());
      aiColor4D colour(1, 1, 1, 1);
      if (mesh.HasVertexColors(0)) colour = mesh.mColors[0][i];
      mesh_.colours.push_back({double{colour.r} * double{factor.r}, double{colour.g} * double{factor.g},
                               double{colour.b} * double{factor.b}});
      check_numbers("colour", i, mesh_.colours.back());
    }
    const auto texcoord = static_cast<int>(mesh_.texcoords.size()), normal = static_cast<int>(mesh_.normals.size());
    for (unsigned i = 0; mesh.HasTextureCoords(0) && i < mesh.mNumVertices; ++i) {
      mesh_.texcoords.push_back({double{mesh.mTextureCoords[0][i].x}, double{mesh.mTextureCoords[0][i].y}});
      check_numbers("texture coordinate", i, mesh_.texcoords.back());
    }
    for (unsigned i = 0; mesh.HasNormals() && i < mesh.mNumVertices; ++i) {
      const auto& n = mesh.mNormals[i];
      const Vec3 given{double{n.x}, double{n.y}, double{n.z}};
      check_numbers("normal", i, given);
      mesh_.normals.push_back(placed ? turned(given, m, sign) : given);
    }
    const auto corner = [&](unsigned vertex) {
      const auto i = static_cast<int>(vertex);
      return Corner{static_cast<int>(first) + i, mesh.HasTextureCoords(0) ? texcoord + i : -1,
                    mesh.HasNormals() ? normal + i : -1};
    };
    add_faces(mesh, !ngons_.empty() && ngons_[index], sign < 0, corner);
  }

  template <class MakeCorner>
  void add_faces(const aiMesh& mesh, bool ngons, bool mirrored, MakeCorner&& corner) {
    const std::size_t before = mesh_.faces.size();
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3 && format_ != MeshFormat::gltf)
        throw failure("face " + std::to_string(f) + " has " + std::to_string(face.mNumIndices) +
                      " corners; at least 3 are needed");
      if (face.mNumIndices < 3) {
        ++points_and_lines_;
        continue;
      }
      read_triangles_ += face.mNumIndices == 3;
      if (const aiFace* last = f > 0 ? &mesh.mFaces[f - 1] : nullptr;
          ngons && last && last->mIndices[0] == face.mIndices[0] && last->mIndices[2] == face.mIndices[1]) {
        mesh_.faces.back().push_back(corner(face.mIndices[2]));
        continue;
      }
      Face& made = mesh_.faces.emplace_back();
      for (unsigned i = 0; i < face.mNumIndices; ++i) made.push_back(corner(face.mIndices[i]));
    }
    if (!mirrored) return;
    for (std::size_t f = before; f < mesh_.faces.size(); ++f)  // corner 0 stays
      std::reverse(mesh_.faces[f].begin() + 1, mesh_.faces[f].end());
  }

  aiColor4D base_colour(const aiMesh& mesh) const {
    aiColor4D colour(1, 1, 1, 1);
    if (format_ == MeshFormat::gltf && mesh.mMaterialIndex < scene_->mNumMaterials)
      static_cast<void>(scene_->mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_BASE_COLOR, colour));
    return colour;
  }

  /// A unit normal of a placed surface.
  static Vec3 turned(const Vec3& n, const aiMatrix4x4t<double>& m, double sign) {
    const Vec3 moved{
        (m.b2 * m.c3 - m.b3 * m.c2) * n[0] + (m.b3 * m.c1 - m.b1 * m.c3) * n[1] + (m.b1 * m.c2 - m.b2 * m.c1) * n[2],
        (m.a3 * m.c2 - m.a2 * m.c3) * n[0] + (m.a1 * m.c3 - m.a3 * m.c1) * n[1] + (m.a2 * m.c1 - m.a1 * m.c2) * n[2],
        (m.a2 * m.b3 - m.a3 * m.b2) * n[0] + (m.a3 * m.b1 - m.a1 * m.b3) * n[1] + (m.a1 * m.b2 - m.a2 * m.b1) * n[2]};
    const double length = std::hypot(moved[0], moved[1], moved[2]);
    return length > 0 ? Vec3{sign * moved[0] / length, sign * moved[1] / length, sign * moved[2] / length} : n;
  }

  template <class Values>
  void check_numbers(const char* what, unsigned vertex, const Values& values) const {
    for (const double value : values)
      if (!(std::abs(value) <= max_input_magnitude))
        throw failure("the " + std::string(what) + " of vertex " + std::to_string(vertex) + " holds " +
                      number_text(value) + "; finite numbers of magnitude up to 2^80 are expected");
  }

  void note_counts(bool pairs) {
    const auto note = [&](const std::string& text) { mesh_.notes.insert(mesh_.notes.begin(), text); };
    if (points_and_lines_ > 0) note(std::to_string(points_and_lines_) + " points and lines are not drawn");
    if (format_ != MeshFormat::gltf) return;
    const auto triangles =
        static_cast<std::size_t>(std::ranges::count_if(mesh_.faces, [](const Face& face) { return face.size() == 3; }));
    if (mesh_.faces.size() < read_triangles_)
      note("FB_ngon_encoding: " + std::to_string(read_triangles_) + " triangles became " +
           std::to_string(mesh_.faces.size() - triangles) + " polygons, " + std::to_string(triangles) +
           " stayed triangles");
    else if (!pairs)
      note("glTF has no quads, and all " + std::to_string(triangles) +
           " faces are triangles; --merge-pairs (in Python merge_pairs=True) joins those that were quads");
  }

  const std::string& path_;
  const MeshFormat format_;
  std::vector<bool> ngons_;  ///< of glTF's primitives, in order
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
  Mesh mesh_;
  bool coloured_ = false;
  std::size_t read_triangles_ = 0, points_and_lines_ = 0;
};

}  // namespace

Mesh import_mesh(const std::string& path, bool pairs) { return Importer(path).run(pairs); }

}  // namespace quadrille::golden
