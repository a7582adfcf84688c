#include "engine/io/mesh/obj_contents.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

namespace reljef::io {
namespace {

bool is_blank(char character) {
    return character == ' ' || character == '\t' || character == '\r';
}

// Takes the characters of a file one by one.
class ObjReader {
public:
    void take(char character) {
        const bool is_continued = after_backslash_;
        after_backslash_ = character == '\\' || (is_continued && character == '\r');
        if (character == '\n' && !is_continued) {
            end_line();
        } else if (is_blank(character) || character == '\\' || character == '\n') {
            in_word_ = false;
            add_to_name(' ');
        } else {
            take_of_word(character);
        }
    }

    ObjContents finish() {
        end_line();
        return std::move(contents_);
    }

private:
    static constexpr std::size_t max_key = 8;
    static constexpr std::size_t max_name = 4096;

    void take_of_word(char character) {
        words_ += static_cast<std::uint64_t>(!in_word_);
        in_word_ = true;
        if (words_ == 1 && key_.size() < max_key) {
            key_ += character;
        } else if (words_ > 1) {
            add_to_name(character);
        }
    }

    // Names may have blanks within.
    void add_to_name(char character) {
        const bool has_name = key_ == "mtllib" || key_ == "usemtl";
        if (has_name && name_.size() < max_name && (character != ' ' || !name_.empty())) {
            name_ += character;
        }
    }

    void end_line() {
        while (name_.ends_with(' ')) {
            name_.pop_back();
        }
        if (key_ == "f" && words_ > 3) {
            const std::uint64_t corners = words_ - 1; // a word for the key
            contents_.triangles += corners - 2;
            contents_.max_corners = std::max(contents_.max_corners, corners);
            contents_.face_work += corners > 4 ? corners * corners : 0;
        } else if (key_ == "usemtl" && name_ != material_) {
            material_ = name_;
            ++contents_.material_changes;
        } else if (key_ == "mtllib" && !name_.empty() &&
                   contents_.libraries.size() < max_obj_libraries) {
            contents_.libraries.push_back(name_);
        }
        key_.clear();
        name_.clear();
        words_ = 0;
        in_word_ = false;
    }

    ObjContents contents_;
    std::string key_;
    std::string name_;
    std::string material_;
    std::uint64_t words_ = 0; // of the line
    bool in_word_ = false;
    bool after_backslash_ = false;
};

} // namespace

Result<ObjContents> obj_contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> block(std::size_t{1} << 20U);
    ObjReader reader;
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        for (const char character :
             std::string_view(block.data(), static_cast<std::size_t>(stream.gcount()))) {
            reader.take(character);
        }
    }
    if (!stream.eof()) {
        return Error{fmt::format("{}: cannot be read, an OBJ file was expected", file.string())};
    }
    return reader.finish();
}

} // namespace reljef::io
