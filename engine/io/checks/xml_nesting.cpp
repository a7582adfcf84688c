#include "engine/io/checks/xml_nesting.h"

#include <array>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

namespace reljef::io {
namespace {

// Counts the elements that are open after each character (XML 1.0, section 3). Of what is no
// well-formed XML, it counts elements that readers may take for open.
class XmlDepth {
public:
    [[nodiscard]] int depth() const { return depth_; }

    void read(char next) {
        if (!ending_.empty()) {
            read_until_ending(next);
        } else if (quote_ != '\0') {
            quote_ = next == quote_ ? '\0' : quote_;
        } else if (is_in_tag_) {
            read_in_tag(next);
        } else if (next == '<') {
            is_in_tag_ = true;
            begin_ = {};
            begin_count_ = 0;
        }
        before_ = next;
    }

private:
    void read_until_ending(char next) {
        matched_ = next == ending_[matched_]             ? matched_ + 1
                   : next == ending_[0] && matched_ == 2 ? matched_ // "]]]>", "--->"
                   : next == ending_[0]                  ? 1
                                                         : 0;
        if (matched_ == ending_.size()) {
            ending_ = {};
            is_in_tag_ = false;
        }
    }

    void read_in_tag(char next) {
        if (begin_count_ < begin_.size()) {
            begin_[begin_count_] = next;
            ++begin_count_;
        }
        const std::string_view begin(begin_.data(), begin_count_);
        const bool is_markup = begin[0] == '!' || begin[0] == '?';
        if (begin == "!--" || begin == "![CDATA[") {
            ending_ = begin == "!--" ? "-->" : "]]>";
            matched_ = 0;
        } else if (next == '>') {
            const bool is_closed = before_ == '/' && begin_count_ > 1;
            depth_ += is_markup || is_closed ? 0 : begin[0] == '/' ? -1 : 1;
            depth_ = depth_ < 0 ? 0 : depth_;
            is_in_tag_ = false;
        } else if ((next == '"' || next == '\'') && begin[0] != '/') {
            quote_ = next;
        }
    }

    int depth_ = 0;
    bool is_in_tag_ = false;
    char before_ = '\0';
    char quote_ = '\0';
    std::array<char, 8> begin_{}; // of a tag
    std::size_t begin_count_ = 0;
    std::string_view ending_ = {}; // of what has no elements
    std::size_t matched_ = 0;
};

} // namespace

Result<void> check_xml_nesting(const std::filesystem::path& path, int max_depth) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 1 << 16> piece;
    XmlDepth elements;
    bool is_xml = false;
    while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
        for (const char next :
             std::string_view(piece.data(), static_cast<std::size_t>(file.gcount()))) {
            const bool is_blank =
                next == '\0' || std::isspace(static_cast<unsigned char>(next)) != 0;
            if (!is_xml && !is_blank && next != '<' && static_cast<unsigned char>(next) < 0x80) {
                return {}; // bytes above ASCII may mark the encoding
            }
            is_xml = is_xml || next == '<';
            if (next != '\0') { // of UTF-16
                elements.read(next);
            }
            if (elements.depth() > max_depth) {
                return Error{fmt::format("{}: elements nested more than {} deep found, at most "
                                         "that many were expected",
                                         path.string(), max_depth)};
            }
        }
    }
    return {};
}

} // namespace reljef::io
