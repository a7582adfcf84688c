#include "tests/architecture/source_rules.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "tests/architecture/include_table.h"

namespace reljef::test {
namespace {

using Names = std::vector<std::string_view>;

bool is_identifier(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t after(std::string_view text, std::string_view what, std::size_t from) {
    const std::size_t found = text.find(what, from);
    return found == std::string_view::npos ? text.size() : found + what.size();
}

std::size_t end_of_quoted(std::string_view text, std::size_t begin) {
    for (std::size_t i = begin + 1; i < text.size(); ++i) {
        if (text[i] == '\\') {
            ++i;
        } else if (text[i] == text[begin]) {
            return i + 1;
        }
    }
    return text.size();
}

std::size_t end_of_raw_string(std::string_view text, std::size_t begin) {
    const std::size_t open = text.find('(', begin);
    if (open == std::string_view::npos) {
        return text.size();
    }
    const std::string close = ")" + std::string(text.substr(begin + 2, open - begin - 2)) + "\"";
    return after(text, close, open);
}

// The end of the comment or literal that begins here; `begin` where none does.
std::size_t end_of_quiet(std::string_view text, std::size_t begin) {
    const std::string_view rest = text.substr(begin);
    const bool in_word = begin > 0 && is_identifier(text[begin - 1]);
    if (rest.starts_with("//")) {
        return std::min(text.find('\n', begin), text.size());
    }
    if (rest.starts_with("/*")) {
        return after(text, "*/", begin + 2);
    }
    if (rest.starts_with("R\"") && !in_word) {
        return end_of_raw_string(text, begin);
    }
    if (rest.starts_with('"') || (rest.starts_with('\'') && !in_word)) { // not 1'000
        return end_of_quoted(text, begin);
    }
    return begin;
}

bool starts_with_any(std::string_view text, const Names& beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view beginning) { return text.starts_with(beginning); });
}

struct Library {
    std::string_view name;
    Names headers; // how their paths begin
    Names folders; // where they may be included
};

const std::vector<Library>& guarded_libraries() {
    static const std::vector<Library> libraries{
        {"GeographicLib", {"GeographicLib/"}, {"engine/geo/", "tests/geo/"}},
        {"GDAL", {"gdal", "ogr", "cpl_", "vrtdataset"}, {"engine/io/", "tests/io/"}},
        {"GEOS", {"geos"}, {"engine/io/footprints/"}},
        {"libcurl", {"curl/"}, {"engine/io/remote/"}},
        {"Assimp", {"assimp/"}, {"engine/io/mesh/"}},
        {"OpenImageIO", {"OpenImageIO/"}, {"engine/io/codec/", "tests/io/"}},
        {"libpng", {"png"}, {"engine/io/image/"}},
        {"libtiff", {"tiff"}, {"engine/io/codec/", "tests/io/"}},
        {"CLI11", {"CLI/"}, {"app/", "bench/", "tests/"}},
        {"Highway", {"hwy/"}, {"engine/cast/", "engine/terrain/light/"}},
        {"meshoptimizer", {"meshoptimizer"}, {"engine/scene/levels/"}},
        {"Embree", {"embree"}, {"engine/cast/mesh/", "bench/baselines/embree/", "tests/truth/"}},
        {"Dear ImGui", {"imgui", "backends/imgui"}, {"app/viewer/panels/", "tests/app/panels/"}},
        {"Irrlicht", {"irrlicht"}, {"bench/baselines/irrlicht/"}},
        {"OpenSceneGraph", {"osg"}, {"bench/baselines/openscenegraph/"}},
    };
    return libraries;
}

bool may_use_gl(std::string_view path) {
    return starts_with_any(path, {"engine/gl/", "engine/platform/", "engine/render/", "tests/gl/",
                                  "tests/platform/", "bench/baselines/irrlicht/",
                                  "bench/baselines/openscenegraph/"}) ||
           (path.starts_with("tests/") && path.ends_with("_gl_test.cpp"));
}

} // namespace

std::string code_of(std::string_view text) {
    std::string code(text);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = end_of_quiet(text, i);
        const bool literal = end > i && text[i] != '/';
        for (std::size_t k = i; k < end; ++k) {
            const bool border = literal && (k == i || k + 1 == end);
            code[k] = border || text[k] == '\n' ? text[k] : ' ';
        }
        i = std::max(end, i + 1);
    }
    return code;
}

std::vector<Include> includes_of(std::string_view text) {
    static const std::regex directive(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*["<])");
    const std::string code = code_of(text);
    std::vector<Include> includes;
    for (std::sregex_iterator match(code.begin(), code.end(), directive), end; match != end;
         ++match) {
        const auto begin = static_cast<std::size_t>(match->position() + match->length());
        const bool quoted = text[begin - 1] == '"';
        const std::size_t close = std::min(text.find(quoted ? '"' : '>', begin), text.size());
        includes.push_back({std::string(text.substr(begin, close - begin)), quoted});
    }
    return includes;
}

Complaints forbidden_includes(const SourceFile& file) {
    Complaints complaints;
    const std::string from = room_of(file.path);
    for (const Include& include : includes_of(file.text)) {
        const std::string to = room_of(include.path);
        if (!to.empty() && !may_include(from, to)) {
            complaints.push_back(file.path + " includes " + include.path + ": " + from +
                                 " may not include " + to);
        }
        if (to.empty() == include.quoted) {
            complaints.push_back(file.path + " includes " + include.path +
                                 ": the project's own files are included from the root in quotes, "
                                 "libraries in angle brackets");
        }
    }
    return complaints;
}

Complaints libraries_outside_their_room(const SourceFile& file) {
    Complaints complaints;
    for (const Include& include : includes_of(file.text)) {
        for (const Library& library : guarded_libraries()) {
            if (!include.quoted && starts_with_any(include.path, library.headers) &&
                !starts_with_any(file.path, library.folders)) {
                complaints.push_back(file.path + " includes " + include.path + ": only " +
                                     std::string(library.folders.front()) + " may include " +
                                     std::string(library.name));
            }
        }
    }
    return complaints;
}

Complaints gl_outside_its_rooms(const SourceFile& file) {
    static const std::regex call(R"(\bgl[A-Z]\w*\s*\()");
    Complaints complaints;
    if (may_use_gl(file.path)) {
        return complaints;
    }
    for (const Include& include : includes_of(file.text)) {
        if (starts_with_any(include.path, {"glad/", "GL/", "EGL/", "GLES", "GLFW/", "KHR/"})) {
            complaints.push_back(file.path + " includes " + include.path + " outside GL's rooms");
        }
    }
    const std::string code = code_of(file.text);
    for (std::sregex_iterator match(code.begin(), code.end(), call), end; match != end; ++match) {
        complaints.push_back(file.path + " calls " + match->str() + ") outside GL's rooms");
    }
    return complaints;
}

Complaints uniforms_by_string(const SourceFile& file) {
    static const std::regex by_string(
        R"(\bset\w*\s*\(\s*"|\bUniform(?:Declaration)?\b|\bgl\w*Uniform\w*|\bbind\w*\s*\(\s*[\d"])");
    Complaints complaints;
    if (!file.path.starts_with("engine/render/") ||
        file.path.starts_with("engine/render/shaders/")) {
        return complaints;
    }
    const std::string code = code_of(file.text);
    for (std::sregex_iterator match(code.begin(), code.end(), by_string), end; match != end;
         ++match) {
        complaints.push_back(file.path + " has " + match->str() +
                             ": uniforms and bindings are named in engine/render/shaders");
    }
    return complaints;
}

Complaints techniques_by_string(const SourceFile& file) {
    static const std::regex parsed_literal(
        R"(\bparse_technique\s*\(\s*(?:"|R"|std::string\b|fmt::))");
    // A baseline's label has the same form.
    static const std::regex literal(R"("(?!irrlicht:)[a-z][a-z-]*:[a-z]+=)");
    Complaints complaints;
    if (starts_with_any(file.path,
                        {"engine/scene/technique/", "app/cli/", "terrains/", "tests/"})) {
        return complaints;
    }
    const std::string code = code_of(file.text);
    for (std::sregex_iterator match(code.begin(), code.end(), parsed_literal), end; match != end;
         ++match) {
        complaints.push_back(file.path + " parses a technique from its own text: a value of "
                                         "scene::Technique was expected");
    }
    for (std::sregex_iterator match(file.text.begin(), file.text.end(), literal), end; match != end;
         ++match) {
        if (code[static_cast<std::size_t>(match->position())] == '"') { // in no comment
            complaints.push_back(file.path + " has " + match->str() +
                                 ": a value of scene::Technique was expected");
        }
    }
    return complaints;
}

Complaints printing_exiting_or_throwing(const SourceFile& file) {
    static const std::regex forbidden(
        R"(\bfmt::print\w*|\bstd::(?:cout|cerr|clog|wcout|wcerr)\b|\bthrow\b|)"
        R"((?:^|[^\w.>])(?:(?:vf|v|f)?printf|f?puts|f?putc|putchar|perror|)"
        R"(exit|_exit|_Exit|quick_exit|abort|terminate)\s*\()");
    Complaints complaints;
    if (!starts_with_any(file.path, {"engine/", "terrains/"}) ||
        starts_with_any(file.path, {"engine/core/check."})) {
        return complaints;
    }
    const std::string code = code_of(file.text);
    for (std::sregex_iterator match(code.begin(), code.end(), forbidden), end; match != end;
         ++match) {
        complaints.push_back(file.path + " has " + match->str() +
                             ": a library returns errors and notes as values");
    }
    return complaints;
}

Complaints machine_paths(const SourceFile& file) {
    static const std::regex path(R"((?:^|[^\w.\-}])(/(?:work|home|root|Users|tmp)/[\w.\-/]*))");
    Complaints complaints;
    for (std::sregex_iterator match(file.text.begin(), file.text.end(), path), end; match != end;
         ++match) {
        complaints.push_back(file.path + " names " + match->str(1) + ", a place on one machine");
    }
    return complaints;
}

Complaints private_headers_in_public_ones(std::span<const SourceFile> files) {
    static const std::regex separators("[\\s()]+");
    std::set<std::string> is_public;
    for (const SourceFile& file : files) {
        if (!file.path.ends_with("CMakeLists.txt")) {
            continue;
        }
        std::sregex_token_iterator word(file.text.begin(), file.text.end(), separators, -1);
        bool in_headers = false;
        for (; word != std::sregex_token_iterator(); ++word) {
            in_headers = *word == "HEADERS" || (in_headers && *word != "SOURCES");
            if (in_headers) {
                is_public.insert(folder_of(file.path) + "/" + word->str());
            }
        }
    }
    Complaints complaints;
    for (const SourceFile& file : files) {
        if (!is_public.contains(file.path)) {
            continue;
        }
        for (const Include& include : includes_of(file.text)) {
            if (include.quoted && include.path.ends_with(".h") &&
                !is_public.contains(include.path)) {
                complaints.push_back(file.path + " is installed and includes " + include.path +
                                     ", which is not");
            }
        }
    }
    return complaints;
}

Complaints unlisted_files(std::span<const SourceFile> files) {
    static const std::regex separators("[\\s()]+");
    std::map<std::string, std::set<std::string>> listed; // by folder, as paths from the root
    for (const SourceFile& file : files) {
        if (file.path.ends_with("CMakeLists.txt")) {
            std::set<std::string>& names = listed[folder_of(file.path)];
            std::sregex_token_iterator word(file.text.begin(), file.text.end(), separators, -1);
            names.insert(word, {});
        }
    }
    Complaints complaints;
    for (const SourceFile& file : files) {
        if (!file.path.ends_with(".cpp") && !file.path.ends_with(".h")) {
            continue;
        }
        const std::string own_folder = folder_of(file.path);
        std::string folder = own_folder;
        while (!folder.empty() && !listed.contains(folder)) {
            folder = folder_of(folder);
        }
        folder = folder.empty() ? own_folder : folder;
        if (!listed[folder].contains(file.path.substr(folder.size() + 1))) {
            complaints.push_back(file.path + " is not named in " + folder + "/CMakeLists.txt");
        }
    }
    return complaints;
}

Complaints crowded_folders(std::span<const SourceFile> files) {
    static const std::regex ending(R"((_gl)?(_test)?\.\w+$)");
    std::map<std::string, std::set<std::string>> concepts;
    for (const SourceFile& file : files) {
        const std::string folder = folder_of(file.path);
        const std::string name = file.path.substr(folder.size() + 1);
        if (name != "CMakeLists.txt") {
            concepts[folder].insert(std::regex_replace(name, ending, ""));
        }
    }
    Complaints complaints;
    for (const auto& [folder, names] : concepts) {
        if (names.size() > max_concepts) {
            complaints.push_back(fmt::format("{} holds {} concepts, at most {} were expected",
                                             folder, names.size(), max_concepts));
        }
    }
    return complaints;
}

Complaints long_file(const SourceFile& file) {
    const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
    return lines <= max_lines ? Complaints()
                              : Complaints{fmt::format("{} has {} lines, at most {} were expected",
                                                       file.path, lines, max_lines)};
}

} // namespace reljef::test
