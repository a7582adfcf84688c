#include "engine/io/formats/toml_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/core/geometry.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/web_tiles.h"

namespace reljef::io {
namespace {

std::string text_of_value(const toml::node& node) {
    std::ostringstream stream;
    node.visit([&](const auto& value) {
        if constexpr (toml::is_value<decltype(value)>) {
            stream << value;
        }
    });
    return stream.str();
}

std::string text_of(const toml::array& array) {
    std::vector<std::string> values;
    for (const toml::node& element : array) {
        if (!element.is_value()) {
            return "an array";
        }
        values.push_back(text_of_value(element));
    }
    return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string text_of(const toml::node& node) {
    if (node.is_table()) {
        return "a table";
    }
    std::string text = node.is_array() ? text_of(*node.as_array()) : text_of_value(node);
    constexpr std::size_t longest = 60;
    if (text.size() > longest) {
        text.resize(longest);
        text += "…";
    }
    return text;
}

std::string text_of(const NumberRange& range) {
    const double max_double = std::numeric_limits<double>::max();
    const std::string low = range.above_low ? fmt::format("above {}", range.low)
                                            : fmt::format("of at least {}", range.low);
    if (range.high >= max_double) {
        return range.low <= -max_double ? "finite" : low;
    }
    return range.above_low ? fmt::format("above {} and at most {}", range.low, range.high)
                           : fmt::format("from {} to {}", range.low, range.high);
}

bool within(double value, const NumberRange& range) {
    return std::isfinite(value) && value <= range.high &&
           (range.above_low ? value > range.low : value >= range.low);
}

constexpr int max_name_parts = 64;

// The end of a string; the end of the text if it is not closed.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
    const char quote = text[begin];
    const std::string three(3, quote);
    const bool is_long = text.substr(begin, 3) == three;
    const std::string_view closing = is_long ? std::string_view(three) : text.substr(begin, 1);
    for (std::size_t i = begin + closing.size(); i < text.size(); ++i) {
        if (text[i] == '\\' && quote == '"') {
            ++i;
        } else if (text.substr(i, closing.size()) == closing) {
            return i + closing.size();
        } else if (text[i] == '\n' && !is_long) {
            return i;
        }
    }
    return text.size();
}

// The line of the first dotted name with too many parts for the recursive parser's stack.
std::optional<std::ptrdiff_t> line_of_endless_name(std::string_view text) {
    constexpr std::string_view between_names = "=,[]{}\n";
    int parts = 1;
    std::size_t i = 0;
    while (i < text.size()) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            i = end_of_string(text, i);
            continue;
        }
        if (c == '#') {
            i = std::min(text.find('\n', i), text.size());
            continue;
        }
        parts = between_names.find(c) != std::string_view::npos ? 1 : parts + (c == '.' ? 1 : 0);
        if (parts > max_name_parts) {
            return 1 +
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
        }
        ++i;
    }
    return std::nullopt;
}

// Addresses are absolute. The folder of web tiles follows a '+'.
std::filesystem::path path_in(const std::filesystem::path& folder, const std::string& name) {
    if (is_web_tiles(name)) {
        const auto address = name.find('+') + 1;
        const std::filesystem::path rest = path_in(folder, name.substr(address));
        return name.substr(0, address) + rest.string();
    }
    return is_remote(name) || name.find("://") != std::string::npos ? std::filesystem::path(name)
                                                                    : folder / name;
}

// An array of `n` numbers of at most max_world_coordinate.
template <int n> std::optional<glm::vec<n, double>> coordinates_of(const toml::node& node) {
    const toml::array* array = node.as_array();
    glm::vec<n, double> found{0.0};
    bool good = array != nullptr && array->size() == n;
    for (int i = 0; good && i < n; ++i) {
        const toml::node& element = *array->get(static_cast<std::size_t>(i));
        const auto number = element.is_number() ? element.value<double>() : std::optional<double>();
        good = number && std::abs(*number) <= max_world_coordinate;
        found[i] = number.value_or(0.0);
    }
    return good ? std::optional(found) : std::nullopt;
}

} // namespace

Result<toml::table> parse_toml(std::string_view text, const std::string& name) {
    if (const auto line = line_of_endless_name(text)) {
        return Error{fmt::format("{}:{}: has a name of over {} parts, fewer were expected", name,
                                 *line, max_name_parts)};
    }
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& problem) {
        return Error{fmt::format("{}:{}: is no TOML: {}", name, problem.source().begin.line,
                                 problem.description())};
    } catch (const std::exception& problem) {
        return Error{fmt::format("{}: is no TOML: {}", name, problem.what())};
    }
}

TomlTable::TomlTable(const toml::table& table, std::string name, std::string label)
    : table_(&table), name_(std::move(name)), label_(std::move(label)) {}

std::string TomlTable::at(const toml::node* node) const {
    const toml::source_index line = node != nullptr ? node->source().begin.line : 0;
    const std::string place = line > 0 ? fmt::format("{}:{}", name_, line) : name_;
    return label_.empty() ? place : fmt::format("{}: {}", place, label_);
}

void TomlTable::fail(std::string_view key, const std::string& found_and_expected) {
    if (!error_) {
        const std::string place = at(table_->get(key));
        error_ = Error{
            fmt::format("{}{} {} {}", place, label_.empty() ? ":" : "", key, found_and_expected)};
    }
}

const toml::node* TomlTable::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        known_.emplace_back(key);
    }
    return table_->get(key);
}

void TomlTable::require(std::initializer_list<std::string_view> keys) {
    const std::string_view last = *(keys.end() - 1);
    const std::string expected =
        keys.size() == 1
            ? fmt::format("{} was", last)
            : fmt::format("{} and {} were", fmt::join(keys.begin(), keys.end() - 1, ", "), last);
    for (const std::string_view key : keys) {
        if (!has(key)) {
            fail(key, fmt::format("is missing, {} expected", expected));
        }
    }
}

std::optional<double> TomlTable::number(std::string_view key, const NumberRange& range,
                                        bool is_whole) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    const bool is_number = is_whole ? node->is_integer() : node->is_number();
    const auto value = is_number ? node->value<double>() : std::optional<double>();
    if (!value || !within(*value, range)) {
        fail(key, fmt::format("is {}, a {}number {} was expected", text_of(*node),
                              is_whole ? "whole " : "", text_of(range)));
        return std::nullopt;
    }
    return value;
}

void TomlTable::read(std::string_view key, double& value, const NumberRange& range) {
    value = number(key, range).value_or(value);
}

void TomlTable::read(std::string_view key, std::optional<double>& value, const NumberRange& range) {
    if (const auto found = number(key, range)) {
        value = found;
    }
}

void TomlTable::read(std::string_view key, int& value, const NumberRange& range) {
    value = static_cast<int>(number(key, range, true).value_or(value));
}

void TomlTable::read(std::string_view key, std::uint32_t& value, const NumberRange& range) {
    value = static_cast<std::uint32_t>(number(key, range, true).value_or(value));
}

void TomlTable::read(std::string_view key, bool& value) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_boolean()) {
        fail(key, fmt::format("is {}, true or false was expected", text_of(*node)));
    } else if (node != nullptr) {
        value = node->as_boolean()->get();
    }
}

void TomlTable::read(std::string_view key, std::string& value) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return;
    }
    if (!node->is_string() || node->as_string()->get().empty()) {
        fail(key, fmt::format("is {}, a text in quotes was expected", text_of(*node)));
        return;
    }
    value = node->as_string()->get();
}

void TomlTable::read(std::string_view key, std::string& value,
                     std::span<const std::string_view> words) {
    std::string found;
    read(key, found);
    if (found.empty()) {
        return;
    }
    if (std::find(words.begin(), words.end(), found) == words.end()) {
        fail(key, fmt::format("is \"{}\", one of {} was expected", found, fmt::join(words, ", ")));
        return;
    }
    value = found;
}

void TomlTable::read(std::string_view key, std::filesystem::path& value,
                     const std::filesystem::path& folder) {
    std::string found;
    read(key, found);
    if (!found.empty()) {
        value = path_in(folder, found);
    }
}

void TomlTable::read(std::string_view key, std::vector<std::filesystem::path>& values,
                     const std::filesystem::path& folder) {
    const toml::node* node = find(key);
    const toml::array* array = node != nullptr ? node->as_array() : nullptr;
    if (array == nullptr) {
        std::filesystem::path only;
        read(key, only, folder);
        if (!only.empty()) {
            values = {only};
        }
        return;
    }
    values.clear();
    for (const toml::node& element : *array) {
        if (!element.is_string() || element.as_string()->get().empty()) {
            fail(key, fmt::format("has {} in its list, texts in quotes were expected",
                                  text_of(element)));
            return;
        }
        values.push_back(path_in(folder, element.as_string()->get()));
    }
    if (values.empty()) {
        fail(key, "is an empty list, at least one text was expected");
    }
}

void TomlTable::read(std::string_view key, std::optional<glm::dvec3>& value) {
    const toml::node* node = find(key);
    const auto found = node != nullptr ? coordinates_of<3>(*node) : std::nullopt;
    if (found) {
        value = found;
    } else if (node != nullptr) {
        fail(key, fmt::format("is {}, three numbers [x, y, z] of at most {} metres were expected",
                              text_of(*node), max_world_coordinate));
    }
}

void TomlTable::read(std::string_view key, std::optional<glm::dvec2>& value) {
    const toml::node* node = find(key);
    const auto found = node != nullptr ? coordinates_of<2>(*node) : std::nullopt;
    if (found) {
        value = found;
    } else if (node != nullptr) {
        fail(key, fmt::format("is {}, two numbers of at most {} were expected", text_of(*node),
                              max_world_coordinate));
    }
}

void TomlTable::read_all(std::map<std::string, std::vector<double>>& values, std::size_t max,
                         double limit) {
    for (const auto& [key, node] : *table_) {
        const std::string name(key.str());
        known_.push_back(name);
        const toml::array single{node.is_number() ? node.value_or(0.0) : limit * 2.0};
        const toml::array& numbers = node.is_array() ? *node.as_array() : single;
        std::vector<double> found;
        for (const toml::node& number : numbers) {
            found.push_back(number.is_number() ? number.value_or(0.0) : limit * 2.0);
        }
        const bool is_good = !found.empty() && found.size() <= max &&
                             std::all_of(found.begin(), found.end(),
                                         [&](double value) { return std::abs(value) <= limit; });
        if (is_good) {
            values.insert_or_assign(name, std::move(found));
        } else {
            fail(name, fmt::format("is {}, a number or a list of 1 to {} numbers was expected",
                                   text_of(node), max));
        }
    }
}

TomlTable TomlTable::table(std::string_view key) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) {
        const bool is_list = node->is_array_of_tables();
        fail(key, is_list ? fmt::format("is a list [[{0}]], one table [{0}] was expected", key)
                          : fmt::format("is {}, a table [{}] was expected", text_of(*node), key));
        node = nullptr;
    }
    static const toml::table empty;
    return {node != nullptr ? *node->as_table() : empty, name_, fmt::format("[{}]", key)};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
    std::vector<TomlTable> result;
    const toml::node* node = find(key);
    if (node == nullptr) {
        return result;
    }
    const toml::array* array = node->as_array();
    if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
        fail(key, fmt::format("is {}, tables [[{}]] were expected", text_of(*node), key));
        return result;
    }
    for (const toml::node& element : *array) {
        result.emplace_back(*element.as_table(), name_, fmt::format("[[{}]]", key));
    }
    return result;
}

Result<void> TomlTable::finish() const {
    if (error_) {
        return *error_;
    }
    for (const auto& [key, node] : *table_) {
        const std::string_view word = key.str();
        if (std::find(known_.begin(), known_.end(), word) == known_.end()) {
            return Error{fmt::format("{}{} {} is unknown, one of {} was expected", at(&node),
                                     label_.empty() ? ":" : "", word, fmt::join(known_, ", "))};
        }
    }
    return {};
}

} // namespace reljef::io
