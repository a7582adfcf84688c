#include "engine/io/mesh/mesh_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/io/mesh/corner_mesh.h"
#include "engine/io/mesh/gltf_file.h"
#include "engine/io/mesh/import_files.h"
#include "engine/io/mesh/near_file.h"

namespace reljef::io {
namespace {

constexpr std::array<std::string_view, 3> extensions{".obj", ".gltf", ".glb"};

// glTF 1 has the same extensions as glTF 2.
void keep_one_importer(Assimp::Importer& importer, const std::string& extension) {
    const std::string_view kept =
        extension == ".obj" ? "Wavefront Object Importer" : "glTF2 Importer";
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        if (importer.GetImporterInfo(i)->mName != kept) {
            importer.UnregisterLoader(importer.GetImporter(i));
        }
    }
}

// Where a node lies, metres of the file.
struct Placement {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};
};

Placement placed(const Placement& parent, const aiMatrix4x4& node) {
    const glm::dmat3 linear(glm::dvec3(node.a1, node.b1, node.c1), // columns
                            glm::dvec3(node.a2, node.b2, node.c2),
                            glm::dvec3(node.a3, node.b3, node.c3));
    return {parent.linear * linear,
            parent.linear * glm::dvec3(node.a4, node.b4, node.c4) + parent.offset};
}

// Adding 0 makes −0 a 0: the bits of equal vertices are compared.
glm::vec3 z_up(glm::dvec3 v) {
    return glm::vec3(v.x, -v.z, v.y) + 0.0F;
}

glm::dvec3 vector_of(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

glm::dvec3 normal_at(const aiMesh& mesh, unsigned vertex) {
    return mesh.HasNormals() ? vector_of(mesh.mNormals[vertex]) : glm::dvec3(0.0);
}

glm::vec2 texture_coordinate_at(const aiMesh& mesh, unsigned vertex) {
    const aiVector3D at =
        mesh.HasTextureCoords(0) ? mesh.mTextureCoords[0][vertex] : aiVector3D(0.0F);
    return glm::vec2(at.x, at.y) + 0.0F;
}

// 0 where there is none.
glm::vec3 normal_of(glm::dvec3 v) {
    const double length = glm::length(v);
    return length > 0.0 && std::isfinite(length) ? z_up(v / length) : glm::vec3(0.0F);
}

bool has_good_corners(const aiMesh& mesh) {
    const bool has_all = mesh.mNumFaces == 0 || mesh.mVertices != nullptr;
    return has_all &&
           std::all_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces, [&](const aiFace& face) {
               return std::all_of(face.mIndices, face.mIndices + face.mNumIndices,
                                  [&](unsigned corner) { return corner < mesh.mNumVertices; });
           });
}

// The triangles of a scene by material, with corners that no triangles share.
class Parts {
public:
    explicit Parts(const aiScene& scene) : scene_(scene) {}

    // A node and those below it.
    Result<void> add(const aiNode& node, const Placement& parent) {
        const Placement place = placed(parent, node.mTransformation);
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            if (node.mMeshes[i] < scene_.mNumMeshes) {
                add(*scene_.mMeshes[node.mMeshes[i]], place);
            }
            if (triangles_ > max_mesh_triangles) {
                return Error{fmt::format("{} triangles found, at most {} were expected", triangles_,
                                         max_mesh_triangles)};
            }
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) {
            if (auto good = add(*node.mChildren[i], place); !good) {
                return good;
            }
        }
        return {};
    }

    [[nodiscard]] std::size_t triangles() const { return triangles_; }
    [[nodiscard]] std::map<unsigned, scene::Mesh>& by_material() { return meshes_; }

private:
    void add(const aiMesh& found, const Placement& place) {
        scene::Mesh& mesh = meshes_[found.mMaterialIndex];
        const glm::dmat3& linear = place.linear;
        const bool is_mirrored = glm::determinant(linear) < 0.0;
        // The inverse transpose but for its size, also of what has no inverse.
        const glm::dmat3 turn =
            glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                       glm::cross(linear[0], linear[1])) *
            (is_mirrored ? -1.0 : 1.0);
        const std::array<unsigned, 3> order{0, is_mirrored ? 2U : 1U, is_mirrored ? 1U : 2U};
        for (unsigned i = 0; i < found.mNumFaces; ++i) {
            const aiFace& face = found.mFaces[i];
            if (face.mNumIndices != 3) {
                continue;
            }
            ++triangles_;
            for (const unsigned corner : order) {
                const unsigned vertex = face.mIndices[corner];
                mesh.positions.push_back(
                    z_up(linear * vector_of(found.mVertices[vertex]) + place.offset));
                mesh.normals.push_back(normal_of(turn * normal_at(found, vertex)));
                mesh.texture_coordinates.push_back(texture_coordinate_at(found, vertex));
            }
        }
    }

    const aiScene& scene_;
    std::map<unsigned, scene::Mesh> meshes_;
    std::size_t triangles_ = 0;
};

void take_texture(const aiScene& scene, const aiMaterial& material, MeshPart& part) {
    aiString name;
    const bool is_found =
        material.GetTexture(aiTextureType_BASE_COLOR, 0, &name) == aiReturn_SUCCESS ||
        material.GetTexture(aiTextureType_DIFFUSE, 0, &name) == aiReturn_SUCCESS;
    if (!is_found) {
        return;
    }
    const aiTexture* const embedded = scene.GetEmbeddedTexture(name.C_Str());
    if (embedded == nullptr || embedded->mHeight != 0) {
        part.texture = name.C_Str();
        std::replace(part.texture.begin(), part.texture.end(), '\\', '/');
        return;
    }
    const auto* const bytes = reinterpret_cast<const std::byte*>(embedded->pcData);
    part.picture.assign(bytes, bytes + embedded->mWidth);
}

MeshPart part_of(const aiScene& scene, unsigned number, const scene::Mesh& corners) {
    MeshPart part;
    part.mesh = joined_corners(corners);
    if (number >= scene.mNumMaterials) {
        return part;
    }
    const aiMaterial& material = *scene.mMaterials[number];
    aiColor4D color(0.8F, 0.8F, 0.8F, 1.0F);
    if (material.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS) {
        material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    }
    part.color = {color.r, color.g, color.b};
    take_texture(scene, material, part);
    return part;
}

// Printable ASCII on one line, and not much of it.
std::string plain_text(std::string_view text) {
    constexpr std::size_t longest = 200;
    std::string plain(text.substr(0, longest));
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
    return plain;
}

Error too_large() {
    return {"takes more memory than an import may have, a smaller mesh was expected"};
}

Result<std::vector<MeshPart>> parts_of(const aiScene& scene) {
    constexpr float hard_edge = 45.0F; // degrees
    Parts found(scene);
    if (scene.mRootNode != nullptr) {
        if (auto good = found.add(*scene.mRootNode, {}); !good) {
            return good.error();
        }
    }
    auto& meshes = found.by_material();
    if (found.triangles() == 0 || meshes.size() > max_mesh_parts) {
        return Error{fmt::format("{} triangles of {} materials found, 1 to {} of at most {} were "
                                 "expected",
                                 found.triangles(), meshes.size(), max_mesh_triangles,
                                 max_mesh_parts)};
    }
    std::vector<MeshPart> parts;
    for (auto& [material, mesh] : meshes) {
        add_missing_normals(mesh, hard_edge);
        parts.push_back(part_of(scene, material, mesh));
        mesh = {};
    }
    return parts;
}

Error unreadable(std::string_view problem) {
    return {fmt::format("cannot be read ({}), an OBJ or glTF 2.0 file was expected",
                        plain_text(problem))};
}

// `file`: absolute. `contents`: see ImportFiles.
Result<std::vector<MeshPart>> imported(const std::filesystem::path& file, std::string contents) {
    Assimp::Importer importer;
    auto* const files = new ImportFiles(file, std::move(contents));
    importer.SetIOHandler(files); // owns it
    keep_one_importer(importer, extension_of(file));
    const aiScene* scene = importer.ReadFile(file.string(), 0);
    if (!files->problem().empty()) {
        return Error{files->problem()};
    }
    // Assimp's own steps for normals, equal vertices, nodes and checks take a time that grows with
    // the square of the file's size, and more.
    if (scene != nullptr) {
        if (!std::all_of(scene->mMeshes, scene->mMeshes + scene->mNumMeshes,
                         [](const aiMesh* mesh) { return has_good_corners(*mesh); })) {
            return unreadable("corners without vertices");
        }
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_FlipUVs);
    }
    const std::string problem = importer.GetErrorString();
    if (problem.find("bad_alloc") != std::string::npos) { // Assimp catches it
        return too_large();
    }
    return scene != nullptr ? parts_of(*scene) : unreadable(problem);
}

} // namespace

Result<std::vector<MeshPart>> import_mesh(const std::filesystem::path& file) {
    const std::string extension = extension_of(file);
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
        return Error{fmt::format("extension '{}' found, .obj, .gltf or .glb was expected",
                                 plain_text(extension))};
    }
    try {
        Result<std::string> contents = std::string();
        if (extension != ".obj") {
            contents = reduced_gltf(file);
        }
        return contents ? imported(std::filesystem::absolute(file), std::move(*contents))
                        : Result<std::vector<MeshPart>>(contents.error());
    } catch (const std::bad_alloc&) {
        return too_large();
    } catch (const std::exception& problem) {
        return unreadable(problem.what());
    }
}

} // namespace reljef::io
