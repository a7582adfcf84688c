#include "engine/io/mesh/mesh_import.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <assimp/DefaultIOSystem.h>
#include <assimp/GltfMaterial.h>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "engine/io/mesh/gltf_check.h"
#include "engine/io/mesh/near_file.h"

namespace reljef::io {
namespace {

constexpr std::array<std::string_view, 3> extensions{".obj", ".gltf", ".glb"};

// Makes comments of an OBJ file's lines with groups and objects: Assimp takes over 20 s for 50,000
// of them, and reljef needs materials only.
class WithoutGroups : public Assimp::IOStream {
public:
    explicit WithoutGroups(std::unique_ptr<Assimp::IOStream> file) : file_(std::move(file)) {}

    std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
        const std::size_t items = file_->Read(buffer, size, count);
        auto* const bytes = static_cast<char*>(buffer);
        for (std::size_t i = 0; i < items * size; ++i) {
            char& c = bytes[i];
            const bool is_continued = before_ == '\\';
            if (before_ == '\n' && (c == 'g' || c == 'o')) {
                c = '#';
            }
            before_ = is_continued && c == '\n' ? ' ' : is_continued && c == '\r' ? '\\' : c;
        }
        return items;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t place = file_->Tell();
        const aiReturn done = file_->Seek(offset, origin);
        if (file_->Tell() != place) {
            before_ = file_->Tell() == 0 ? '\n' : ' ';
        }
        return done;
    }
    [[nodiscard]] std::size_t Tell() const override { return file_->Tell(); }
    [[nodiscard]] std::size_t FileSize() const override { return file_->FileSize(); }
    void Flush() override {}

private:
    std::unique_ptr<Assimp::IOStream> file_;
    char before_ = '\n'; // what the next character follows
};

// Opens files of one folder, and of limited size together.
class FolderFiles : public Assimp::DefaultIOSystem {
public:
    explicit FolderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    bool Exists(const char* name) const override {
        return is_file_below(folder_, name) && DefaultIOSystem::Exists(name);
    }
    Assimp::IOStream* Open(const char* name, const char* mode) override {
        std::error_code code;
        if (!is_file_below(folder_, name) || std::strchr(mode, 'w') != nullptr) {
            return nullptr;
        }
        const bool is_new = opened_.insert(name).second; // importers open a file again
        const std::uintmax_t size = is_new ? std::filesystem::file_size(name, code) : 0;
        if (code || size > left_) {
            return nullptr;
        }
        left_ -= size;
        std::unique_ptr<Assimp::IOStream> file(DefaultIOSystem::Open(name, mode));
        return file != nullptr && extension_of(name) == ".obj"
                   ? new WithoutGroups(std::move(file)) // the importer's
                   : file.release();
    }

private:
    std::filesystem::path folder_;
    std::set<std::string> opened_;
    std::uintmax_t left_ = max_mesh_bytes;
};

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

void set_up(Assimp::Importer& importer, const std::filesystem::path& file) {
    constexpr float hard_edge = 45.0F; // degrees
    constexpr int left_out = aiComponent_ANIMATIONS | aiComponent_BONEWEIGHTS |
                             aiComponent_CAMERAS | aiComponent_LIGHTS | aiComponent_COLORS |
                             aiComponent_TANGENTS_AND_BITANGENTS;
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, hard_edge);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, left_out);
    importer.SetIOHandler(new FolderFiles(file.parent_path())); // the importer's
    keep_one_importer(importer, extension_of(file));
}

glm::vec3 z_up(const aiVector3D& v) {
    return {v.x, -v.z, v.y};
}

scene::Mesh mesh_of(const aiMesh& found) {
    scene::Mesh mesh;
    for (unsigned i = 0; i < found.mNumVertices; ++i) {
        mesh.positions.push_back(z_up(found.mVertices[i]));
        mesh.normals.push_back(found.HasNormals() ? z_up(found.mNormals[i]) : glm::vec3(0.0F));
        const aiVector3D at =
            found.HasTextureCoords(0) ? found.mTextureCoords[0][i] : aiVector3D(0.0F);
        mesh.texture_coordinates.emplace_back(at.x, at.y);
    }
    for (unsigned i = 0; i < found.mNumFaces; ++i) {
        const aiFace& face = found.mFaces[i];
        if (face.mNumIndices == 3) {
            mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + 3);
        }
    }
    return mesh;
}

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

MeshPart part_of(const aiScene& scene, const aiMesh& found) {
    MeshPart part;
    part.mesh = mesh_of(found);
    if (found.mMaterialIndex >= scene.mNumMaterials) {
        return part;
    }
    const aiMaterial& material = *scene.mMaterials[found.mMaterialIndex];
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
    std::size_t triangles = 0;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        triangles += scene.mMeshes[i]->mNumFaces;
    }
    if (triangles == 0 || triangles > max_mesh_triangles || scene.mNumMeshes > max_mesh_parts) {
        return Error{fmt::format("{} triangles in {} parts found, 1 to {} in at most {} were "
                                 "expected",
                                 triangles, scene.mNumMeshes, max_mesh_triangles, max_mesh_parts)};
    }
    std::vector<MeshPart> parts;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        parts.push_back(part_of(scene, *scene.mMeshes[i]));
    }
    return parts;
}

} // namespace

Result<std::vector<MeshPart>> import_mesh(const std::filesystem::path& file) {
    constexpr unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType |
                               aiProcess_RemoveComponent | aiProcess_GenSmoothNormals |
                               aiProcess_FlipUVs | aiProcess_PreTransformVertices |
                               aiProcess_JoinIdenticalVertices | aiProcess_ValidateDataStructure;
    const std::string extension = extension_of(file);
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
        return Error{fmt::format("extension '{}' found, .obj, .gltf or .glb was expected",
                                 plain_text(extension))};
    }
    try {
        if (extension != ".obj") {
            if (auto good = check_gltf(file); !good) {
                return good.error();
            }
        }
        Assimp::Importer importer;
        set_up(importer, std::filesystem::absolute(file));
        const aiScene* const scene =
            importer.ReadFile(std::filesystem::absolute(file).string(), steps);
        const std::string problem = importer.GetErrorString();
        if (problem.find("bad_alloc") != std::string::npos) { // Assimp catches it
            return too_large();
        }
        if (scene == nullptr) {
            return Error{fmt::format("cannot be read ({}), an OBJ or glTF 2.0 file was expected",
                                     plain_text(problem))};
        }
        return parts_of(*scene);
    } catch (const std::bad_alloc&) {
        return too_large();
    } catch (const std::exception& problem) {
        return Error{fmt::format("cannot be read ({}), an OBJ or glTF 2.0 file was expected",
                                 plain_text(problem.what()))};
    }
}

} // namespace reljef::io
