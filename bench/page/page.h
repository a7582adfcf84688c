#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

#include "bench/report/row_view.h"
#include "engine/core/atomic_file.h"
#include "engine/core/result.h"

namespace reljef::bench {

struct RowPictures {
    std::size_t row = 0; ///< index into the report's rows
    std::shared_ptr<const RowView> view;
};

/// What write_page() writes into a folder, which may be named with a slash at its end.
std::filesystem::path page_file(const std::filesystem::path& folder);

/// Whether write_page() can put a page there: asked before long work, leaves nothing behind.
Result<void> check_page_target(const std::filesystem::path& folder);

/// A folder that goes again with this object where it was made and is still empty.
class MadeFolder {
public:
    /// Where there is one already, it stays.
    static Result<MadeFolder> make(const std::filesystem::path& folder);

    MadeFolder(MadeFolder&& other) noexcept : folder_(std::exchange(other.folder_, {})) {}
    MadeFolder& operator=(MadeFolder&&) = delete;
    MadeFolder(const MadeFolder&) = delete;
    MadeFolder& operator=(const MadeFolder&) = delete;
    ~MadeFolder();

private:
    explicit MadeFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    std::filesystem::path folder_; // empty: it was not made here
};

/// A page that is written and not yet there.
struct PreparedPage {
    MadeFolder folder; // goes after the file
    AtomicFile file;
};

/// Writes `folder`/index.html beside its place; PreparedPage::file.commit() puts it there: one page
/// that holds its style, its program, the report and the pictures, and needs nothing else.
/// `json_report` is JSON of the schema schema_name; strings in it may hold anything. Makes the
/// folder where only its parent exists. A truth that several rows share is in the page once.
/// Precondition: rows named exist and have a view.
Result<PreparedPage> prepare_page(const std::filesystem::path& folder, std::string_view json_report,
                                  std::span<const RowPictures> pictures);

/// The same, whole or not at all.
Result<void> write_page(const std::filesystem::path& folder, std::string_view json_report,
                        std::span<const RowPictures> pictures);

} // namespace reljef::bench
