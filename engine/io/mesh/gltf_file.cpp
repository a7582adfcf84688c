#include "engine/io/mesh/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>

#include "engine/io/mesh/gltf_check.h"
#include "engine/io/mesh/gltf_json.h"

namespace reljef::io {
namespace {

// A GLB: magic, version, length; then chunks of a size, a kind and bytes. JSON is the first.
constexpr std::size_t chunk_begin = 12;
constexpr std::size_t json_begin = 20;

struct GltfText {
    std::string head; // of a GLB: all before the JSON; otherwise empty
    std::string json;
    std::string rest; // of a GLB: the other chunks
};

GltfText text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!bytes.starts_with("glTF") || bytes.size() < json_begin) {
        return {"", std::move(bytes), ""};
    }
    std::uint32_t stated = 0; // bytes of JSON
    std::memcpy(&stated, bytes.data() + chunk_begin, sizeof stated);
    const std::size_t size = std::min<std::size_t>(stated, bytes.size() - json_begin);
    const std::size_t rest = std::min(bytes.size(), json_begin + (size + 3) / 4 * 4);
    return {bytes.substr(0, json_begin), bytes.substr(json_begin, size), bytes.substr(rest)};
}

void write_number(std::string& bytes, std::size_t place, std::size_t number) {
    const auto value = static_cast<std::uint32_t>(number);
    std::memcpy(bytes.data() + place, &value, sizeof value);
}

std::string bytes_of(GltfText text) {
    if (text.head.empty()) {
        return std::move(text.json);
    }
    text.json.resize((text.json.size() + 3) / 4 * 4, ' ');
    const std::size_t size = json_begin + text.json.size() + text.rest.size();
    write_number(text.head, chunk_begin - 4, size);
    write_number(text.head, chunk_begin, text.json.size());
    return text.head + text.json + text.rest;
}

// Names may have bytes that are no UTF-8; reljef shows none.
Json parsed(std::string& text) {
    Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        std::replace_if(
            text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80U; },
            '?');
        json = Json::parse(text, nullptr, false);
    }
    return json;
}

using Keys = std::initializer_list<std::string_view>;

void keep(Json& object, Keys keys) {
    if (!object.is_object()) {
        return;
    }
    for (auto member = object.begin(); member != object.end();) {
        const bool is_kept = std::find(keys.begin(), keys.end(), member.key()) != keys.end();
        member = is_kept ? std::next(member) : object.erase(member);
    }
}

// A member of an object; none where there is none.
Json* member(Json& object, const char* key) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() ? &*found : nullptr;
}

void keep(Json& object, const char* key, Keys keys) {
    if (Json* const found = member(object, key)) {
        keep(*found, keys);
    }
}

template <class Change> void change_each(Json& object, const char* list, Change change) {
    Json* const found = member(object, list);
    if (found != nullptr && found->is_array()) {
        std::for_each(found->begin(), found->end(), change);
    }
}

constexpr const char* glossiness = "KHR_materials_pbrSpecularGlossiness"; // colours of older files

void reduce_mesh(Json& mesh) {
    keep(mesh, {"primitives"});
    change_each(mesh, "primitives", [](Json& primitive) {
        keep(primitive, {"attributes", "indices", "material", "mode"});
        keep(primitive, "attributes", {"POSITION", "NORMAL", "TEXCOORD_0"});
    });
}

void reduce_material(Json& material) {
    keep(material, {"pbrMetallicRoughness", "extensions"});
    keep(material, "pbrMetallicRoughness", {"baseColorFactor", "baseColorTexture"});
    keep(material, "extensions", {glossiness});
    if (Json* const color = member(material, "pbrMetallicRoughness")) {
        keep(*color, "baseColorTexture", {"index"});
    }
    if (Json* const extensions = member(material, "extensions")) {
        keep(*extensions, glossiness, {"diffuseFactor", "diffuseTexture"});
        if (Json* const color = member(*extensions, glossiness)) {
            keep(*color, "diffuseTexture", {"index"});
        }
    }
}

void reduce(Json& file) {
    keep(file, {"asset", "extensionsUsed", "scene", "scenes", "nodes", "meshes", "materials",
                "textures", "images", "accessors", "bufferViews", "buffers"});
    keep(file, "asset", {"version"});
    if (Json* const used = member(file, "extensionsUsed")) {
        const bool has_glossiness =
            std::find(used->begin(), used->end(), glossiness) != used->end();
        *used = has_glossiness ? Json::array({glossiness}) : Json::array();
    }
    change_each(file, "scenes", [](Json& scene) { keep(scene, {"nodes"}); });
    change_each(file, "nodes", [](Json& node) {
        keep(node, {"mesh", "children", "matrix", "translation", "rotation", "scale"});
    });
    change_each(file, "meshes", reduce_mesh);
    change_each(file, "materials", reduce_material);
    change_each(file, "textures", [](Json& texture) { keep(texture, {"source"}); });
    change_each(file, "images", [](Json& image) {
        keep(image, {"uri", "bufferView", "mimeType"});
    });
}

} // namespace

Result<std::string> reduced_gltf(const std::filesystem::path& file) {
    GltfText text = text_of(file);
    if (auto good = check_gltf_depth(text.json); !good) {
        return good.error();
    }
    Json json = parsed(text.json);
    if (!json.is_object()) {
        return Error{"holds no JSON that can be read, a glTF 2.0 file was expected"};
    }
    text.json.clear();
    text.json.shrink_to_fit();
    if (auto good = check_gltf(json); !good) {
        return good.error();
    }
    if (auto good = check_gltf_accessors(json); !good) {
        return good.error();
    }
    reduce(json);
    text.json = json.dump();
    return bytes_of(std::move(text));
}

} // namespace reljef::io
