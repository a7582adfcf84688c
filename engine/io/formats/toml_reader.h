#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <toml++/toml.h>

#include "engine/core/result.h"

namespace reljef::io {

/// Parses a TOML text; `name` is the file in errors.
Result<toml::table> parse_toml(std::string_view text, const std::string& name);

/// Range of finite numbers.
struct NumberRange {
    double low = 0.0;
    double high = 0.0;
    bool above_low = false; ///< excludes `low`
};

/// Reads the keys of a table. An absent key keeps its default. finish() returns the first error: a
/// wrong type, a value out of range or an unknown key.
class TomlTable {
public:
    /// `name`: file; `label`: table, such as "[sun]", or empty for the document.
    TomlTable(const toml::table& table, std::string name, std::string label);

    void read(std::string_view key, double& value, const NumberRange& range);
    void read(std::string_view key, std::optional<double>& value, const NumberRange& range);
    void read(std::string_view key, int& value, const NumberRange& range);
    void read(std::string_view key, std::uint32_t& value, const NumberRange& range);
    void read(std::string_view key, bool& value);
    void read(std::string_view key, std::string& value);
    /// One of `words`.
    void read(std::string_view key, std::string& value, std::span<const std::string_view> words);
    /// A path relative to `folder`, an address, or web tiles of heights; not empty.
    void read(std::string_view key, std::filesystem::path& value,
              const std::filesystem::path& folder);
    /// One or more of these.
    void read(std::string_view key, std::vector<std::filesystem::path>& values,
              const std::filesystem::path& folder);
    /// Three numbers of at most max_world_coordinate.
    void read(std::string_view key, std::optional<glm::dvec3>& value);
    /// Two numbers of at most max_world_coordinate.
    void read(std::string_view key, std::optional<glm::dvec2>& value);

    /// Each key's number, or list of 1 to `max` numbers, of at most `limit` in size.
    void read_all(std::map<std::string, std::vector<double>>& values, std::size_t max,
                  double limit);

    /// A nested table; empty if absent.
    TomlTable table(std::string_view key);
    /// An array of tables; empty if absent.
    std::vector<TomlTable> tables(std::string_view key);

    [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
    /// Fails for each absent key.
    void require(std::initializer_list<std::string_view> keys);
    /// Sets the error of a key unless there is one.
    void fail(std::string_view key, const std::string& found_and_expected);
    [[nodiscard]] Result<void> finish() const;

private:
    const toml::node* find(std::string_view key);
    std::optional<double> number(std::string_view key, const NumberRange& range,
                                 bool is_whole = false);
    [[nodiscard]] std::string at(const toml::node* node) const;

    const toml::table* table_;
    std::string name_;
    std::string label_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

} // namespace reljef::io
