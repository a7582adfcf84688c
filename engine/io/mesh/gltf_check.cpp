#include "engine/io/mesh/gltf_check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/io/mesh/mesh_message.h"

namespace reljef::io {
namespace {

using Json = nlohmann::json;

std::string bytes_of(std::ifstream& stream, std::uint64_t size) {
    constexpr std::uint64_t step = 1U << 20U; // a file may state more than it has
    std::string bytes;
    while (stream && bytes.size() < size) {
        const std::size_t begin = bytes.size();
        const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(step, size - begin));
        bytes.resize(begin + more);
        stream.read(bytes.data() + begin, static_cast<std::streamsize>(more));
        bytes.resize(begin + static_cast<std::size_t>(stream.gcount()));
    }
    return bytes;
}

// The JSON of a file: all of it, or the first chunk of a GLB.
std::string json_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    constexpr std::size_t header_size = 20; // magic, version, length; size and kind of the chunk
    std::string header = bytes_of(stream, header_size);
    if (header.starts_with("glTF")) {
        std::uint32_t size = 0;
        if (header.size() == header_size) {
            std::memcpy(&size, header.data() + 12, sizeof size);
        }
        return bytes_of(stream, size);
    }
    return header + bytes_of(stream, std::numeric_limits<std::uint64_t>::max());
}

// The deepest nesting of braces and brackets outside strings.
int depth_of(std::string_view json) {
    int depth = 0;
    int deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string && c == '\\') {
            ++i;
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string && (c == '{' || c == '[')) {
            deepest = std::max(deepest, ++depth);
        } else if (!in_string && (c == '}' || c == ']')) {
            --depth;
        }
    }
    return deepest;
}

// Null where there is none.
const Json& at(const Json& json, const char* key) {
    static const Json none;
    const auto found = json.is_object() ? json.find(key) : json.end();
    return found != json.end() ? *found : none;
}

const Json& at(const Json& list, const Json& index) {
    static const Json none;
    const bool is_index =
        list.is_array() && index.is_number_unsigned() && index.get<std::uint64_t>() < list.size();
    return is_index ? list[index.get<std::size_t>()] : none;
}

double number_of(const Json& json) {
    return json.is_number() ? std::max(0.0, json.get<double>()) : 0.0;
}

std::size_t size_of(const Json& json) {
    return json.is_array() ? json.size() : 0;
}

// Triangles of the meshes and of the scene, as the accessors state them.
class GltfTriangles {
public:
    explicit GltfTriangles(const Json& file) : file_(file) {
        for (const Json& mesh : list("meshes")) {
            double triangles = 0.0;
            for (const Json& primitive : at(mesh, "primitives")) {
                triangles += of_primitive(primitive);
            }
            of_meshes_.push_back(triangles);
        }
        of_nodes_.resize(size_of(list("nodes")));
    }

    // Of all meshes, or of all places that show them if these are more. Empty if the nodes are
    // nested deeper than max_gltf_depth.
    std::optional<double> count() {
        double of_file = 0.0;
        for (const double triangles : of_meshes_) {
            of_file += triangles;
        }
        double of_scene = 0.0;
        const Json& chosen = at(file_, "scene");
        for (const Json& node :
             at(at(list("scenes"), chosen.is_null() ? Json(0U) : chosen), "nodes")) {
            const auto more = of_node(node, 1);
            if (!more) {
                return std::nullopt;
            }
            of_scene += *more;
        }
        return std::max(of_file, of_scene);
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

    std::optional<double> of_node(const Json& index, int depth) {
        const Json& node = at(list("nodes"), index);
        if (node.is_null()) {
            return 0.0;
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
        double triangles = has_mesh ? of_meshes_[mesh.get<std::size_t>()] : 0.0;
        for (const Json& child : at(node, "children")) {
            const auto more = of_node(child, depth + 1);
            if (!more) {
                return std::nullopt;
            }
            triangles += *more;
        }
        of_nodes_[place] = triangles;
        return triangles;
    }

    const Json& file_;
    std::vector<double> of_meshes_;
    std::vector<std::optional<double>> of_nodes_; // with their children; absent: not yet known
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

} // namespace

Result<void> check_gltf(const std::filesystem::path& file) {
    const std::string text = json_text(file);
    if (depth_of(text) > max_gltf_depth) {
        return too_deep();
    }
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        return {};
    }
    if (auto good = check_extensions(json); !good) {
        return good;
    }
    const auto triangles = GltfTriangles(json).count();
    if (!triangles) {
        return too_deep();
    }
    if (*triangles > static_cast<double>(max_mesh_triangles)) {
        return Error{fmt::format("{:.0f} triangles found, at most {} were expected", *triangles,
                                 max_mesh_triangles)};
    }
    return {};
}

} // namespace reljef::io
