#include "engine/io/mesh/gltf_json.h"

#include <cstdint>

namespace reljef::io {

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

std::size_t size_of(const Json& json) {
    return json.is_array() ? json.size() : 0;
}

} // namespace reljef::io
