#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "bench/page_heat_map.h"
#include "engine/core/color.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// What a row's technique shows, what is right, and heat_map() of the reprojection error: three
/// pictures of one size.
struct RowPictures {
    std::size_t row = 0; ///< index into the report's rows
    Image shown;
    Image truth;
    Image heat;
};

/// Whether write_page() can put a page there: asked before long work, leaves nothing behind.
Result<void> check_page_target(const std::filesystem::path& folder);

/// Writes `folder`/index.html, whole or not at all: one page that holds its style, its program, the
/// report and the pictures, and needs nothing else. `json_report` is the JSON of the schema
/// "reljef-bench/1"; strings in it may hold anything. Makes the folder where only its parent
/// exists. Pictures and truth become JPEG, heat maps PNG; a truth that several rows share is in the
/// page once. Precondition: rows named exist; a row's pictures are of one size and not empty.
Result<void> write_page(const std::filesystem::path& folder, std::string_view json_report,
                        std::span<const RowPictures> pictures);

} // namespace reljef::bench
