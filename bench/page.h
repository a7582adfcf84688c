#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "bench/row_view.h"
#include "engine/core/result.h"

namespace reljef::bench {

struct RowPictures {
    std::size_t row = 0; ///< index into the report's rows
    std::shared_ptr<const RowView> view;
};

/// Whether write_page() can put a page there: asked before long work, leaves nothing behind.
Result<void> check_page_target(const std::filesystem::path& folder);

/// Writes `folder`/index.html, whole or not at all: one page that holds its style, its program, the
/// report and the pictures, and needs nothing else. `json_report` is the JSON of the schema
/// "reljef-bench/1"; strings in it may hold anything. Makes the folder where only its parent
/// exists. A truth that several rows share is in the page once. Precondition: rows named exist and
/// have a view.
Result<void> write_page(const std::filesystem::path& folder, std::string_view json_report,
                        std::span<const RowPictures> pictures);

} // namespace reljef::bench
