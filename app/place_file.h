#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"

namespace reljef::app {

/// The place, if its latitude is in [-90, 90] and its longitude a number of degrees; `option` is
/// named in the error.
Result<glm::dvec2> checked_place(std::string_view option, glm::dvec2 place);

/// A file of places that is read piece by piece: a line each, LAT,LON in degrees, and what follows
/// another comma is not looked at. Blank lines and lines that begin with # are left out, and the
/// first other line if it begins with no number: a heading. Errors name --points and the file or
/// the line, what was found and what was expected.
class PlaceFile {
public:
    /// "-" is standard input. `piece_bytes`: at most so much is read at a time, and of a line.
    static Result<PlaceFile> open(const std::string& name, std::size_t piece_bytes);

    struct Piece {
        std::vector<glm::dvec2> places;      ///< latitude, longitude
        std::vector<std::string_view> texts; ///< of the places, LAT,LON; good until the next piece
    };
    /// The places of the next whole lines.
    Result<Piece> next();
    [[nodiscard]] bool at_end() const { return at_end_; }

private:
    struct Closer {
        void operator()(std::FILE* file) const;
    };
    PlaceFile(std::FILE* file, std::string name, std::size_t piece_bytes);
    Result<void> read_lines();

    std::unique_ptr<std::FILE, Closer> file_;
    std::string name_;
    std::size_t piece_bytes_;
    std::string text_;           // whole lines
    std::string rest_;           // the beginning of a line
    std::size_t lines_read_ = 0; // of the file, before text_
    bool may_be_heading_ = true; // the next line that is not left out
    bool at_end_ = false;
};

} // namespace reljef::app
