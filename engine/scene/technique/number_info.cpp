#include "engine/scene/technique/number_info.h"

#include <charconv>
#include <string>

#include <fmt/format.h>

namespace reljef::scene {

Result<double> parse_number(std::string_view subject, const NumberInfo& number,
                            std::string_view text) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = code == std::errc{} && end == text.data() + text.size();
    if (!is_number || !number.allows(value)) {
        const bool has_gap = number.min_above_low > number.low;
        return Error{fmt::format("{}: {}={} found, {}a {}number from {} to {} was expected",
                                 subject, number.name, text,
                                 has_gap ? fmt::format("{} or ", number.low) : std::string(),
                                 number.whole ? "whole " : "",
                                 has_gap ? number.min_above_low : number.low, number.high)};
    }
    return value;
}

} // namespace reljef::scene
