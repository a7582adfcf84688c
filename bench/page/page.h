#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bench/report/figure_table.h"
#include "bench/report/results.h"
#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// The file of a page in `folder`, whose name may end with a slash.
std::filesystem::path page_file(const std::filesystem::path& folder);

/// Fails if prepare_page() cannot write there; leaves no trace.
Result<void> check_page_target(const std::filesystem::path& folder);

/// Creates a folder unless it exists. The last copy of the result removes it if it was created here
/// and is still empty.
Result<std::shared_ptr<const std::filesystem::path>>
make_folder(const std::filesystem::path& folder);

/// A page that file.commit() puts in place.
struct PreparedPage {
    std::shared_ptr<const std::filesystem::path> folder; // destroyed after the file
    AtomicFile file;
};

/// Prepares `folder`/index.html: one page with its style, scripts, report and the pictures of rows
/// with a view, without external references. Names in the results are arbitrary. Creates the folder
/// in an existing parent. Rows with the same truth share its picture.
Result<PreparedPage> prepare_page(const std::filesystem::path& folder, const Results& results);

/// The same for rows with columns: sorted tables, and plots of the suites that have one. The suite
/// stress has a page of its own.
Result<PreparedPage> prepare_page(const std::filesystem::path& folder, const FigureTable& table);

/// "data:image/png;base64,…" (RFC 2397, RFC 4648).
std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes);

} // namespace reljef::bench
