#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "engine/io/mesh/gltf_check.h"
#include "engine/io/mesh/gltf_json.h"

namespace reljef::io {
namespace {

// What a place in a mesh may hold.
struct Use {
    const char* key;
    std::string_view type;
    std::array<std::uint64_t, 3> components; // 0: none
    std::string_view expected;
};

constexpr std::uint64_t unsigned_byte = 5121;
constexpr std::uint64_t unsigned_short = 5123;
constexpr std::uint64_t unsigned_int = 5125;
constexpr std::uint64_t float_32 = 5126;

constexpr Use index_use{
    "indices", "SCALAR", {unsigned_byte, unsigned_short, unsigned_int}, "5121, 5123 or 5125"};
constexpr std::array<Use, 3> attribute_uses{
    {{"POSITION", "VEC3", {float_32, 0, 0}, "5126"},
     {"NORMAL", "VEC3", {float_32, 0, 0}, "5126"},
     {"TEXCOORD_0", "VEC2", {float_32, unsigned_byte, unsigned_short}, "5126, 5121 or 5123"}}};

std::uint64_t component_size(std::uint64_t component) {
    return component == unsigned_byte ? 1 : component == unsigned_short ? 2 : 4;
}

// As found, on one line and not long.
std::string text_of(const Json& json) {
    constexpr std::size_t longest = 60;
    return json.is_null()
               ? "nothing"
               : json.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, longest);
}

// An element of a list of the file, as "accessors[3]".
class Element {
public:
    static Result<Element> of(const Json& file, const char* list, const Json& index,
                              const std::string& user) {
        const Json& found = at(at(file, list), index);
        if (!found.is_object()) {
            return Error{fmt::format("{} is {}, the number of one of {} {} was expected", user,
                                     text_of(index), size_of(at(file, list)), list)};
        }
        return Element(found, fmt::format("{}[{}]", list, index.get<std::uint64_t>()));
    }
    Element(const Json& json, std::string name) : json_(&json), name_(std::move(name)) {}

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const Json& value(const char* key) const { return at(*json_, key); }
    [[nodiscard]] std::string name_of(const char* key) const { return name_ + "." + key; }

    // At a key; `missing` where there is none. At most 32 bits: products of two fit.
    [[nodiscard]] Result<std::uint64_t> number(const char* key, std::uint64_t missing) const {
        constexpr std::uint64_t highest = 0xFFFF'FFFFU;
        const Json& found = value(key);
        if (found.is_null()) {
            return missing;
        }
        if (!found.is_number_unsigned() || found.get<std::uint64_t>() > highest) {
            return Error{fmt::format("{} is {}, a whole number from 0 to {} was expected",
                                     name_of(key), text_of(found), highest)};
        }
        return found.get<std::uint64_t>();
    }

private:
    const Json* json_;
    std::string name_;
};

// Where elements lie: `user` is the name of what holds the offset.
struct Layout {
    std::string user;
    std::uint64_t offset = 0; // bytes
    std::uint64_t count = 0;
    std::uint64_t size = 0; // bytes of one
};

Result<void> check_view(const Json& file, const Element& view) {
    const auto offset = view.number("byteOffset", 0);
    const auto length = view.number("byteLength", 0);
    if (!offset || !length) {
        return offset ? length.error() : offset.error();
    }
    const auto buffer = Element::of(file, "buffers", view.value("buffer"), view.name_of("buffer"));
    if (!buffer) {
        return buffer.error();
    }
    const auto size = buffer->number("byteLength", 0);
    if (!size) {
        return size.error();
    }
    if (*offset + *length > *size) {
        return Error{fmt::format("{} reaches to byte {} of {}, at most {} bytes were expected",
                                 view.name(), *offset + *length, buffer->name(), *size)};
    }
    return {};
}

// Elements in the view that `index` names.
Result<void> check_layout(const Json& file, const Json& index, const Layout& layout) {
    const auto view = Element::of(file, "bufferViews", index, layout.user + ".bufferView");
    if (!view) {
        return view.error();
    }
    if (auto good = check_view(file, *view); !good) {
        return good;
    }
    const auto length = view->number("byteLength", 0);
    const auto stride = view->number("byteStride", layout.size);
    if (!length || !stride) {
        return length ? stride.error() : length.error();
    }
    if (*stride < layout.size) {
        return Error{fmt::format("{} is {}, at least the {} bytes of an element of {} were "
                                 "expected",
                                 view->name_of("byteStride"), *stride, layout.size, layout.user)};
    }
    const std::uint64_t end =
        layout.count == 0 ? 0 : layout.offset + (layout.count - 1) * *stride + layout.size;
    if (end > *length) {
        return Error{fmt::format("{} reaches to byte {} of {}, at most {} bytes were expected",
                                 layout.user, end, view->name(), *length)};
    }
    return {};
}

// One list of a sparse accessor.
Result<void> check_sparse_list(const Json& file, const Element& list, std::uint64_t count,
                               std::uint64_t size) {
    const auto offset = list.number("byteOffset", 0);
    return offset
               ? check_layout(file, list.value("bufferView"), {list.name(), *offset, count, size})
               : Result<void>(offset.error());
}

// `size`: bytes of an element.
Result<void> check_sparse(const Json& file, const Element& accessor, std::uint64_t size) {
    const Element sparse(accessor.value("sparse"), accessor.name_of("sparse"));
    const Element indices(sparse.value("indices"), sparse.name_of("indices"));
    const Element values(sparse.value("values"), sparse.name_of("values"));
    const auto count = sparse.number("count", 0);
    const auto component = indices.number("componentType", 0);
    if (!count || !component) {
        return count ? component.error() : count.error();
    }
    const auto& allowed = index_use.components;
    if (std::find(allowed.begin(), allowed.end(), *component) == allowed.end()) {
        return Error{fmt::format("{} is {}, {} was expected", indices.name_of("componentType"),
                                 *component, index_use.expected)};
    }
    if (auto good = check_sparse_list(file, indices, *count, component_size(*component)); !good) {
        return good;
    }
    return check_sparse_list(file, values, *count, size);
}

Result<void> check_type(const Element& accessor, const Use& use) {
    const Json& type = accessor.value("type");
    if (!type.is_string() || type.get_ref<const std::string&>() != use.type) {
        return Error{fmt::format("{} is {}, {} was expected for {}", accessor.name_of("type"),
                                 text_of(type), use.type, use.key)};
    }
    const Json& component = accessor.value("componentType");
    const bool is_allowed =
        std::any_of(use.components.begin(), use.components.end(), [&](std::uint64_t allowed) {
            return allowed > 0 && component.is_number_unsigned() &&
                   component.get<std::uint64_t>() == allowed;
        });
    if (!is_allowed) {
        return Error{fmt::format("{} is {}, {} was expected for {}",
                                 accessor.name_of("componentType"), text_of(component),
                                 use.expected, use.key)};
    }
    return {};
}

// `owner`: what names the accessor, as "meshes[0].primitives[1]".
Result<void> check_accessor(const Json& file, const Json& index, const Use& use,
                            const std::string& owner) {
    const auto accessor = Element::of(file, "accessors", index, owner + "." + use.key);
    if (!accessor) {
        return accessor.error();
    }
    if (auto good = check_type(*accessor, use); !good) {
        return good;
    }
    const std::uint64_t corners = use.type == "SCALAR" ? 1 : use.type == "VEC2" ? 2 : 3;
    const std::uint64_t size =
        corners * component_size(accessor->value("componentType").get<std::uint64_t>());
    const auto count = accessor->number("count", 0);
    const auto offset = accessor->number("byteOffset", 0);
    if (!count || !offset) {
        return count ? offset.error() : count.error();
    }
    if (!accessor->value("sparse").is_null()) {
        if (auto good = check_sparse(file, *accessor, size); !good) {
            return good;
        }
    }
    const Json& view = accessor->value("bufferView");
    return view.is_null() // zeros
               ? Result<void>()
               : check_layout(file, view, {accessor->name(), *offset, *count, size});
}

Result<void> check_primitive(const Json& file, const Json& primitive, const std::string& owner) {
    if (const Json& indices = at(primitive, "indices"); !indices.is_null()) {
        if (auto good = check_accessor(file, indices, index_use, owner); !good) {
            return good;
        }
    }
    const Json& attributes = at(primitive, "attributes");
    for (const Use& use : attribute_uses) {
        if (const Json& index = at(attributes, use.key); !index.is_null()) {
            if (auto good = check_accessor(file, index, use, owner + ".attributes"); !good) {
                return good;
            }
        }
    }
    return {};
}

} // namespace

Result<void> check_gltf_accessors(const Json& file) {
    const Json& meshes = at(file, "meshes");
    for (std::size_t i = 0; i < size_of(meshes); ++i) {
        const Json& primitives = at(meshes[i], "primitives");
        for (std::size_t j = 0; j < size_of(primitives); ++j) {
            const std::string owner = fmt::format("meshes[{}].primitives[{}]", i, j);
            if (auto good = check_primitive(file, primitives[j], owner); !good) {
                return good;
            }
        }
    }
    return {};
}

} // namespace reljef::io
