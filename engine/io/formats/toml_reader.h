#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>
#include <toml++/toml.h>

#include "engine/core/result.h"

namespace reljef::io {

/// The document of a TOML text; the error names `name`, the line and what is wrong with it.
Result<toml::table> parse_toml(std::string_view text, const std::string& name);

/// Numbers that a key may have; never infinite or NaN.
struct NumberRange {
    double low = 0.0;
    double high = 0.0;
    bool above_low = false; ///< `low` itself is out of range
};

/// Reads the keys of one table, all of one kind of file the same way: an absent key leaves its
/// default; the first that is of a wrong type or out of range, or that nobody asked for, is the
/// error.
class TomlTable {
public:
    /// `name` is the file's; `label` the table's, as "[sun]", or empty for the document itself.
    TomlTable(const toml::table& table, std::string name, std::string label);

    void read(std::string_view key, double& value, const NumberRange& range);
    void read(std::string_view key, std::optional<double>& value, const NumberRange& range);
    void read(std::string_view key, int& value, const NumberRange& range);
    void read(std::string_view key, std::uint32_t& value, const NumberRange& range);
    void read(std::string_view key, bool& value);
    void read(std::string_view key, std::string& value);
    /// One of the words.
    void read(std::string_view key, std::string& value, std::span<const std::string_view> words);
    /// A file, relative to `folder`, a folder, an address, or tiles of heights in colours; not
    /// empty.
    void read(std::string_view key, std::filesystem::path& value,
              const std::filesystem::path& folder);
    /// One or more of these.
    void read(std::string_view key, std::vector<std::filesystem::path>& values,
              const std::filesystem::path& folder);
    /// Three numbers of at most world_reach metres.
    void read(std::string_view key, std::optional<glm::dvec3>& value);

    /// A table within; an empty one where there is none.
    TomlTable table(std::string_view key);
    /// The tables of an array of tables; empty where there is none.
    std::vector<TomlTable> tables(std::string_view key);

    [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
    /// Makes a sentence the error, at the line of a key, unless there is one already.
    void fail(std::string_view key, const std::string& found_and_expected);
    /// The first error, or that of a key nobody read.
    [[nodiscard]] Result<void> finish() const;

private:
    const toml::node* find(std::string_view key);
    std::optional<double> number(std::string_view key, const NumberRange& range);
    std::optional<std::int64_t> integer(std::string_view key, const NumberRange& range);
    [[nodiscard]] std::string at(const toml::node* node) const;

    const toml::table* table_;
    std::string name_;
    std::string label_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

} // namespace reljef::io
