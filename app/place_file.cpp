#include "app/place_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace reljef::app {
namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    const auto last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, last - first + 1);
}

struct Line {
    glm::dvec2 place{0.0};
    std::string_view text; // LAT,LON
};

std::optional<Line> line_of(std::string_view text) {
    Line line;
    const char* const end = text.data() + text.size();
    const auto latitude = std::from_chars(text.data(), end, line.place.x);
    if (latitude.ec != std::errc{} || latitude.ptr == end || *latitude.ptr != ',') {
        return std::nullopt;
    }
    const char* begin = latitude.ptr + 1;
    while (begin != end && *begin == ' ') {
        ++begin;
    }
    const auto longitude = std::from_chars(begin, end, line.place.y);
    if (longitude.ec != std::errc{} || (longitude.ptr != end && *longitude.ptr != ',')) {
        return std::nullopt;
    }
    line.text = text.substr(0, static_cast<std::size_t>(longitude.ptr - text.data()));
    return line;
}

// Whether a line names columns: it does not begin with a number, even in quotes.
bool is_heading(std::string_view line) {
    const auto first = line.find_first_not_of("\"'+-. \t");
    return first != std::string_view::npos && (line[first] < '0' || line[first] > '9') &&
           !line_of(line);
}

} // namespace

bool is_place(glm::dvec2 place) {
    return std::abs(place.x) <= 90.0 && std::abs(place.y) <= 1e6;
}

void PlaceFile::Closer::operator()(std::FILE* file) const {
    if (file != stdin) {
        static_cast<void>(std::fclose(file));
    }
}

Result<PlaceFile> PlaceFile::open(const std::string& name, std::size_t piece_bytes) {
    std::FILE* file = name == "-" ? stdin : std::fopen(name.c_str(), "rb");
    if (file == nullptr) {
        return Error{
            fmt::format("--points: '{}' found, a file of lines LAT,LON was expected", name)};
    }
    return PlaceFile(file, name, piece_bytes);
}

Result<void> PlaceFile::read_lines() {
    text_ = std::move(rest_);
    const std::size_t kept = text_.size();
    text_.resize(piece_bytes_);
    text_.resize(kept + std::fread(text_.data() + kept, 1, piece_bytes_ - kept, file_.get()));
    if (std::ferror(file_.get()) != 0) {
        return Error{fmt::format("--points: '{}' cannot be read ({}), a file of lines LAT,LON was "
                                 "expected",
                                 name_, std::generic_category().message(errno))};
    }
    at_end_ = text_.size() < piece_bytes_;
    const auto last = text_.rfind('\n');
    if (!at_end_ && last == std::string::npos) {
        return Error{fmt::format("--points: line {}: over {} bytes found, LAT,LON in degrees was "
                                 "expected",
                                 lines_read_ + 1, piece_bytes_)};
    }
    const std::size_t whole = at_end_ ? text_.size() : last + 1;
    rest_ = text_.substr(whole);
    text_.resize(whole);
    return {};
}

Result<PlaceFile::Piece> PlaceFile::next() {
    if (auto read = read_lines(); !read) {
        return read.error();
    }
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    std::string_view text = text_;
    if (lines_read_ == 0 && text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    Piece piece;
    while (!text.empty()) {
        const std::string_view raw = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(raw.size() + 1, text.size()));
        ++lines_read_;
        const std::string_view whole = trimmed(raw);
        if (whole.empty() || whole.front() == '#') {
            continue;
        }
        const bool is_first = std::exchange(may_be_heading_, false);
        const auto line = line_of(whole);
        if (line && is_place(line->place)) {
            piece.places.push_back(line->place);
            piece.texts.push_back(line->text);
        } else if (!is_first || !is_heading(whole)) {
            return Error{fmt::format("--points: line {}: '{}' found, LAT,LON in degrees was "
                                     "expected",
                                     lines_read_, whole.substr(0, 80))};
        }
    }
    return piece;
}

} // namespace reljef::app
