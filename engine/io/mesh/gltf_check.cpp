#include "engine/io/mesh/gltf_check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "engine/io/mesh/gltf_json.h"

namespace reljef::io {
namespace {

// The deepest nesting of braces and brackets outside strings.
std::size_t depth_of(std::string_view json) {
    std::size_t depth = 0;
    std::size_t deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string && c == '\\') {
            ++i;
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string && (c == '{' || c == '[')) {
            deepest = std::max(deepest, ++depth);
        } else if (!in_string && (c == '}' || c == ']') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

double number_of(const Json& json) {
    return json.is_number() ? std::max(0.0, json.get<double>()) : 0.0;
}

struct SceneSize {
    double triangles = 0.0;
    double nodes = 0.0; // a node with several parents counts for each of them

    SceneSize& operator+=(const SceneSize& more) {
        triangles += more.triangles;
        nodes += more.nodes;
        return *this;
    }
};

// Sizes of the meshes and of the scene, as the accessors state them.
class GltfSize {
public:
    explicit GltfSize(const Json& file) : file_(file) {
        for (const Json& mesh : list("meshes")) {
            double triangles = 0.0;
            for (const Json& primitive : at(mesh, "primitives")) {
                triangles += of_primitive(primitive);
            }
            of_meshes_.push_back(triangles);
        }
        of_nodes_.resize(size_of(list("nodes")));
    }

    // The triangles of all meshes, or of all places that show them if these are more. Empty if the
    // nodes are nested deeper than max_gltf_depth.
    std::optional<SceneSize> count() {
        double of_file = 0.0;
        for (const double triangles : of_meshes_) {
            of_file += triangles;
        }
        SceneSize of_scene;
        const Json& chosen = at(file_, "scene");
        for (const Json& node :
             at(at(list("scenes"), chosen.is_null() ? Json(0U) : chosen), "nodes")) {
            const auto more = of_node(node, 1);
            if (!more) {
                return std::nullopt;
            }
            of_scene += *more;
        }
        of_scene.triangles = std::max(of_file, of_scene.triangles);
        return of_scene;
    }

private:
    [[nodiscard]] const Json& list(const char* key) const { return at(file_, key); }

    [[nodiscard]] double of_primitive(const Json& primitive) const {
        constexpr double strip = 5.0;
        constexpr double fan = 6.0;
        const Json& mode = at(primitive, "mode");
        const double kind = mode.is_null() ? 4.0 : number_of(mode);
        const Json& indices = at(primitive, "indices");
        const Json& accessor =
            indices.is_null() ? at(at(primitive, "attributes"), "POSITION") : indices;
        const double corners = number_of(at(at(list("accessors"), accessor), "count"));
        if (kind == strip || kind == fan) {
            return std::max(0.0, corners - 2.0);
        }
        return kind == 4.0 ? corners / 3.0 : 0.0;
    }

    std::optional<SceneSize> of_node(const Json& index, std::size_t depth) {
        const Json& node = at(list("nodes"), index);
        if (node.is_null()) {
            return SceneSize();
        }
        const auto place = index.get<std::size_t>();
        if (depth > max_gltf_depth) {
            return std::nullopt; // also nodes in a circle
        }
        if (of_nodes_[place]) {
            return of_nodes_[place];
        }
        const Json& mesh = at(node, "mesh");
        const bool has_mesh =
            mesh.is_number_unsigned() && mesh.get<std::uint64_t>() < of_meshes_.size();
        SceneSize size{has_mesh ? of_meshes_[mesh.get<std::size_t>()] : 0.0, 1.0};
        for (const Json& child : at(node, "children")) {
            const auto more = of_node(child, depth + 1);
            if (!more) {
                return std::nullopt;
            }
            size += *more;
        }
        of_nodes_[place] = size;
        return size;
    }

    const Json& file_;
    std::vector<double> of_meshes_;
    std::vector<std::optional<SceneSize>> of_nodes_; // with their children; absent: not yet known
};

// Those of appearance change no triangle.
bool is_known(std::string_view extension) {
    constexpr std::array<std::string_view, 3> known{"KHR_lights_punctual", "KHR_texture_transform",
                                                    "FB_ngon_encoding"};
    return extension.starts_with("KHR_materials_") ||
           std::find(known.begin(), known.end(), extension) != known.end();
}

Result<void> check_extensions(const Json& file) {
    for (const Json& extension : at(file, "extensionsRequired")) {
        const std::string name = extension.is_string() ? extension.get<std::string>() : "";
        if (!is_known(name)) {
            constexpr std::size_t longest = 100;
            return Error{fmt::format("requires the extension {} of glTF, which cannot be read; a "
                                     "file without it was expected",
                                     name.substr(0, longest))};
        }
    }
    return {};
}

Error too_deep() {
    return {fmt::format("is nested more than {} deep, a glTF 2.0 file of fewer levels was expected",
                        max_gltf_depth)};
}

// Of all primitives: those of one accessor are copied for each primitive that names it.
double vertices_of(const Json& file) {
    double vertices = 0.0;
    for (const Json& mesh : at(file, "meshes")) {
        for (const Json& primitive : at(mesh, "primitives")) {
            const Json& position = at(at(primitive, "attributes"), "POSITION");
            vertices += number_of(at(at(at(file, "accessors"), position), "count"));
        }
    }
    return vertices;
}

std::size_t materials_in_use(const Json& file) {
    std::set<std::uint64_t> used;
    for (const Json& mesh : at(file, "meshes")) {
        for (const Json& primitive : at(mesh, "primitives")) {
            if (const Json& material = at(primitive, "material"); material.is_number_unsigned()) {
                used.insert(material.get<std::uint64_t>());
            }
        }
    }
    return used.size();
}

Error too_many(double found, std::string_view what, std::size_t max) {
    return {fmt::format("{:.0f} {} found, at most {} were expected", found, what, max)};
}

} // namespace

Result<void> check_gltf_depth(std::string_view json) {
    return depth_of(json) > max_gltf_depth ? Result<void>(too_deep()) : Result<void>();
}

Result<void> check_gltf(const Json& file) {
    if (auto good = check_extensions(file); !good) {
        return good;
    }
    const auto size = GltfSize(file).count();
    if (!size) {
        return too_deep();
    }
    if (size->triangles > static_cast<double>(max_mesh_triangles)) {
        return too_many(size->triangles, "triangles", max_mesh_triangles);
    }
    if (size->nodes > static_cast<double>(max_gltf_nodes)) {
        return too_many(size->nodes, "nodes", max_gltf_nodes);
    }
    if (const double vertices = vertices_of(file);
        vertices > static_cast<double>(max_gltf_vertices)) {
        return too_many(vertices, "vertices of primitives", max_gltf_vertices);
    }
    if (const std::size_t materials = materials_in_use(file); materials > max_mesh_parts) {
        return too_many(static_cast<double>(materials), "materials in use", max_mesh_parts);
    }
    return {};
}

} // namespace reljef::io
