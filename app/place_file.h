#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

#include "engine/core/result.h"

namespace reljef::app {

/// Whether the latitude is in [-90, 90] and the longitude in [-1e6, 1e6] degrees.
bool is_place(glm::dvec2 place);

/// Reads a file of places piece by piece. Each line begins with LAT,LON in degrees; further columns
/// are ignored. Empty lines, comments (#) and a heading are skipped. Errors name --points and the
/// file or line.
class PlaceFile {
public:
    /// "-" is standard input. `piece_bytes`: size of a piece and longest line.
    static Result<PlaceFile> open(const std::string& name, std::size_t piece_bytes);

    struct Piece {
        std::vector<glm::dvec2> places;      ///< latitude, longitude
        std::vector<std::string_view> texts; ///< LAT,LON as in the file; valid until the next piece
    };
    /// The places of the next whole lines.
    Result<Piece> next();
    [[nodiscard]] bool at_end() const { return at_end_; }

private:
    struct Closer {
        void operator()(std::FILE* file) const;
    };
    PlaceFile(std::FILE* file, std::string name, std::size_t piece_bytes)
        : file_(file), name_(std::move(name)), piece_bytes_(piece_bytes) {}
    Result<void> read_lines();

    std::unique_ptr<std::FILE, Closer> file_;
    std::string name_;
    std::size_t piece_bytes_;
    std::string text_;           // whole lines
    std::string rest_;           // the beginning of a line
    std::size_t lines_read_ = 0; // before text_
    bool may_be_heading_ = true; // the next line that is not skipped
    bool at_end_ = false;
};

} // namespace reljef::app
