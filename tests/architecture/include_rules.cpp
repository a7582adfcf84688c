#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture/source_rules.h"

namespace reljef::test {
namespace {

// Who declares what, as far as cmake/precompiled.h includes it.
const std::map<std::string_view, std::string_view>& declaring_headers() {
    static const std::map<std::string_view, std::string_view> headers{
        {"abs", "cmath"},
        {"acos", "cmath"},
        {"array", "array"},
        {"atan2", "cmath"},
        {"byte", "cstddef"},
        {"ceil", "cmath"},
        {"chrono", "chrono"},
        {"clamp", "algorithm"},
        {"cos", "cmath"},
        {"error_code", "system_error"},
        {"errc", "system_error"},
        {"exchange", "utility"},
        {"filesystem", "filesystem"},
        {"floor", "cmath"},
        {"forward", "utility"},
        {"from_chars", "charconv"},
        {"function", "functional"},
        {"get_if", "variant"},
        {"hypot", "cmath"},
        {"int16_t", "cstdint"},
        {"int32_t", "cstdint"},
        {"int64_t", "cstdint"},
        {"isfinite", "cmath"},
        {"isnan", "cmath"},
        {"less", "functional"},
        {"lround", "cmath"},
        {"make_shared", "memory"},
        {"make_unique", "memory"},
        {"map", "map"},
        {"max", "algorithm"},
        {"min", "algorithm"},
        {"monostate", "variant"},
        {"move", "utility"},
        {"nullopt", "optional"},
        {"numeric_limits", "limits"},
        {"optional", "optional"},
        {"pair", "utility"},
        {"ptrdiff_t", "cstddef"},
        {"reference_wrapper", "functional"},
        {"shared_ptr", "memory"},
        {"sin", "cmath"},
        {"size_t", "cstddef"},
        {"sort", "algorithm"},
        {"span", "span"},
        {"sqrt", "cmath"},
        {"stop_source", "stop_token"},
        {"stop_token", "stop_token"},
        {"string", "string"},
        {"string_view", "string_view"},
        {"swap", "utility"},
        {"to_string", "string"},
        {"uint16_t", "cstdint"},
        {"uint32_t", "cstdint"},
        {"uint64_t", "cstdint"},
        {"uint8_t", "cstdint"},
        {"unique_ptr", "memory"},
        {"variant", "variant"},
        {"vector", "vector"},
        {"visit", "variant"},
        {"weak_ptr", "memory"},
    };
    return headers;
}

// "vector" for each std::vector in the code, "glm/" for each glm::, "fmt/" for each fmt::.
std::set<std::string> declarations_needed(const std::string& code) {
    static const std::regex name(R"(\b(std|glm|fmt)::(\w+))");
    std::set<std::string> needed;
    for (std::sregex_iterator match(code.begin(), code.end(), name), end; match != end; ++match) {
        const auto known = declaring_headers().find(match->str(2));
        if (match->str(1) != "std") {
            needed.insert(match->str(1) + "/");
        } else if (known != declaring_headers().end()) {
            needed.emplace(known->second);
        }
    }
    return needed;
}

// The libraries' headers that come with each of the project's files.
class LibraryIncludes {
public:
    explicit LibraryIncludes(std::span<const SourceFile> files) {
        for (const SourceFile& file : files) {
            includes_[file.path] = includes_of(file.text);
        }
    }

    std::set<std::string> of(const std::string& path) const {
        std::set<std::string> found;
        std::set<std::string> seen;
        collect(path, found, seen);
        return found;
    }

private:
    void collect(const std::string& path, std::set<std::string>& found,
                 std::set<std::string>& seen) const {
        const auto known = includes_.find(path);
        if (known == includes_.end() || !seen.insert(path).second) {
            return;
        }
        for (const Include& include : known->second) {
            if (include.quoted) {
                collect(include.path, found, seen);
            } else {
                found.insert(include.path);
            }
        }
    }

    std::map<std::string, std::vector<Include>> includes_;
};

class CircleSearch {
public:
    explicit CircleSearch(std::span<const SourceFile> files) {
        for (const SourceFile& file : files) {
            for (const Include& include : includes_of(file.text)) {
                includes_[file.path].push_back(include.path);
            }
        }
    }

    Complaints run() {
        for (const auto& [file, includes] : includes_) {
            visit(file);
        }
        return found_;
    }

private:
    void visit(const std::string& file) {
        const auto on_way = std::find(way_.begin(), way_.end(), file);
        if (on_way != way_.end()) {
            report(on_way);
            return;
        }
        const auto known = includes_.find(file);
        if (known == includes_.end() || !seen_.insert(file).second) {
            return;
        }
        way_.push_back(file);
        for (const std::string& included : known->second) {
            visit(included);
        }
        way_.pop_back();
    }

    void report(std::vector<std::string>::const_iterator begin) {
        std::string circle;
        for (auto file = begin; file != way_.cend(); ++file) {
            circle += *file + " -> ";
        }
        found_.push_back(circle + *begin);
    }

    std::map<std::string, std::vector<std::string>> includes_;
    std::set<std::string> seen_;
    std::vector<std::string> way_;
    Complaints found_;
};

} // namespace

Complaints missing_includes(std::span<const SourceFile> files) {
    const LibraryIncludes includes(files);
    Complaints complaints;
    for (const SourceFile& file : files) {
        if (!file.path.ends_with(".h")) {
            continue;
        }
        const std::set<std::string> there = includes.of(file.path);
        for (const std::string& needed : declarations_needed(code_of(file.text))) {
            const auto found = there.lower_bound(needed); // "glm/": whatever begins so
            const bool included =
                found != there.end() &&
                (*found == needed || (needed.ends_with('/') && found->starts_with(needed)));
            if (!included) {
                complaints.push_back(file.path + " needs <" + needed + "> and includes it nowhere");
            }
        }
    }
    return complaints;
}

Complaints include_circles(std::span<const SourceFile> files) {
    return CircleSearch(files).run();
}

} // namespace reljef::test
