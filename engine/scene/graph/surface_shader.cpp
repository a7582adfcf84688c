#include "engine/scene/graph/surface_shader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace reljef::scene {
namespace {

// The words of a text without its comments, and its other characters one by one.
class Words {
public:
    explicit Words(std::string_view text) : rest_(text) {}

    // Empty at the end.
    std::string_view next() {
        skip_blanks();
        const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_of_word);
        const auto length = static_cast<std::size_t>(end - rest_.begin());
        const std::string_view word = rest_.substr(0, std::max<std::size_t>(length, 1));
        rest_.remove_prefix(word.size());
        return word;
    }

private:
    static bool is_of_word(char character) {
        return character == '_' || std::isalnum(static_cast<unsigned char>(character)) != 0;
    }
    static bool is_blank(char character) {
        return std::isspace(static_cast<unsigned char>(character)) != 0;
    }
    void skip_past(std::string_view end) {
        const std::size_t found = rest_.find(end);
        rest_ =
            found == std::string_view::npos ? std::string_view() : rest_.substr(found + end.size());
    }
    void skip_blanks() {
        while (!rest_.empty()) {
            if (rest_.starts_with("//")) {
                skip_past("\n");
            } else if (rest_.starts_with("/*")) {
                skip_past("*/");
            } else if (is_blank(rest_.front())) {
                rest_.remove_prefix(1);
            } else {
                return;
            }
        }
    }

    std::string_view rest_;
};

// Of a type's values; empty for types that a constant cannot have.
std::optional<std::size_t> size_of(std::string_view type) {
    constexpr std::array<std::string_view, 4> types{"float", "vec2", "vec3", "vec4"};
    const auto* const found = std::find(types.begin(), types.end(), type);
    return found == types.end()
               ? std::nullopt
               : std::optional(static_cast<std::size_t>(found - types.begin()) + 1);
}

bool is_identifier(std::string_view name) {
    const auto is_letter = [](char c) {
        return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    return !name.empty() && is_letter(name.front()) &&
           std::all_of(name.begin(), name.end(),
                       [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

Error no_identifier(std::string_view shader, std::string_view name) {
    return {fmt::format("{}: a constant with the name '{}' found, a name of letters, digits and "
                        "'_' was expected, which does not begin with a digit",
                        shader, name)};
}

std::string type_of(std::size_t size) {
    return size == 1 ? "float" : fmt::format("vec{}", size);
}

} // namespace

Result<SurfaceShader> SurfaceShader::create(std::string name, std::string text) {
    if (text.size() > max_bytes) {
        return Error{fmt::format("{}: {} bytes found, at most {} were expected", name, text.size(),
                                 max_bytes)};
    }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.erase(0, byte_order_mark.size());
    }
    if (text.find('\0') != std::string::npos) {
        return Error{fmt::format("{}: a zero byte found, a text was expected", name)};
    }
    SurfaceShader shader(std::move(name), std::move(text));
    Words words(shader.text_);
    bool has_function = false;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        has_function = has_function || word == "surface_color";
        if (word != "uniform") {
            continue;
        }
        const std::string_view type = words.next();
        const auto size = size_of(type);
        if (!size) {
            return Error{
                fmt::format("{}: uniform of type '{}' found, float, vec2, vec3 or vec4 was "
                            "expected",
                            shader.name_, type)};
        }
        const std::string_view constant = words.next();
        if (!is_identifier(constant)) {
            return no_identifier(shader.name_, constant);
        }
        shader.constants_.push_back({std::string(constant), *size});
        const std::string_view end = words.next();
        if (end != ";" && end != "=") {
            return Error{fmt::format("{}: '{}' behind uniform {} {} found, ';' or '=' was expected",
                                     shader.name_, end, type, shader.constants_.back().name)};
        }
        shader.constants_.back().has_default = end == "=";
    }
    if (!has_function) {
        return Error{fmt::format(
            "{}: no function surface_color found, vec3 surface_color(Surface surface) was expected",
            shader.name_)};
    }
    return shader;
}

Result<void> SurfaceShader::check(std::span<const ShaderConstant> constants) const {
    for (const ShaderConstant& constant : constants) {
        if (!is_identifier(constant.name)) {
            return no_identifier(name_, constant.name);
        }
        const auto declared =
            std::find_if(constants_.begin(), constants_.end(),
                         [&](const Declaration& other) { return other.name == constant.name; });
        if (declared == constants_.end()) {
            return Error{fmt::format("{}: no constant '{}' found, uniform {} {} was expected",
                                     name_, constant.name, type_of(constant.values.size()),
                                     constant.name)};
        }
        if (declared->size != constant.values.size()) {
            return Error{fmt::format("{}: constant '{}' with {} {} found, {} was expected", name_,
                                     constant.name, constant.values.size(),
                                     constant.values.size() == 1 ? "value" : "values",
                                     type_of(declared->size))};
        }
    }
    for (const Declaration& declared : constants_) {
        const bool is_given =
            std::any_of(constants.begin(), constants.end(), [&](const ShaderConstant& constant) {
                return constant.name == declared.name;
            });
        if (!is_given && !declared.has_default) {
            return Error{fmt::format("{}: no value of its uniform {} {} found, one was expected: "
                                     "as a constant, or '=' in its declaration",
                                     name_, type_of(declared.size), declared.name)};
        }
    }
    return {};
}

} // namespace reljef::scene
