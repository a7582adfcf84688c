#include "bench/page/page.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/page/page_data_uri.h"
#include "bench/page/page_parts.h"
#include "bench/report/page_heat_map.h"

namespace reljef::bench {
namespace fs = std::filesystem;
namespace {

using PageJson = nlohmann::ordered_json;

constexpr std::string_view page_name = "index.html";

/// Pictures of the page: each once, named by its index.
struct Album {
    std::vector<std::string> uris;
    /// Truths that are in already: rows of one view share theirs.
    std::vector<std::pair<const RowView::File*, std::size_t>> truths;
};

std::size_t add_picture(Album& album, const char* media_type, const RowView::File& file) {
    album.uris.push_back(data_uri(media_type, file));
    return album.uris.size() - 1;
}

std::size_t add_truth(Album& album, const RowView::File& truth) {
    const auto same = std::find_if(album.truths.begin(), album.truths.end(),
                                   [&](const auto& known) { return known.first == &truth; });
    if (same != album.truths.end()) {
        return same->second;
    }
    const std::size_t added = add_picture(album, "image/jpeg", truth);
    album.truths.emplace_back(&truth, added);
    return added;
}

PageJson add_pictures_of(Album& album, const RowPictures& pictures) {
    const RowView& view = *pictures.view;
    return {{"row", pictures.row},
            {"width", view.size.x},
            {"height", view.size.y},
            {"shown", add_picture(album, "image/jpeg", view.shown)},
            {"truth", add_truth(album, *view.truth)},
            {"heat", add_picture(album, "image/png", view.heat)}};
}

std::string css_color(Rgba8 color) {
    return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b);
}

PageJson scale_of_errors() {
    const auto scale = heat_scale();
    PageJson colors = PageJson::array();
    std::transform(scale.begin(), scale.end(), std::back_inserter(colors), css_color);
    return {{"low", heat_low_px},
            {"high", heat_high_px},
            {"unbounded", css_color(heat_unbounded)},
            {"colors", std::move(colors)}};
}

std::string pictures_as_json(std::span<const RowPictures> pictures) {
    Album album;
    PageJson rows = PageJson::array();
    for (const RowPictures& row : pictures) {
        rows.push_back(add_pictures_of(album, row));
    }
    return PageJson{
        {"scale", scale_of_errors()}, {"rows", std::move(rows)}, {"images", std::move(album.uris)}}
        .dump();
}

// How many rows the report has.
Result<std::size_t> rows_of_report(std::string_view json_report) {
    const auto report = PageJson::parse(json_report, nullptr, false);
    const auto text_at = [&](const char* key) {
        return report.contains(key) && report[key].is_string() ? report[key].get<std::string>()
                                                               : std::string();
    };
    if (!report.is_object() || text_at("schema") != schema_name || !report.contains("rows") ||
        !report["rows"].is_array()) {
        return Error{fmt::format("no page can be made: the report is no JSON with rows of the "
                                 "schema {:?}, which was expected",
                                 schema_name)};
    }
    return report["rows"].size();
}

// JSON that ends no script element, whatever its strings hold: in JSON "<" is in strings only.
std::string safe_in_script(std::string_view json) {
    std::string safe;
    safe.reserve(json.size());
    for (const char c : json) {
        if (c == '<') {
            safe += "\\u003c";
        } else {
            safe += c;
        }
    }
    return safe;
}

std::string_view page_part(std::string_view name) {
    const auto parts = page_parts();
    const auto found = std::find_if(parts.begin(), parts.end(),
                                    [&](const PagePart& each) { return each.name == name; });
    check(found != parts.end(), "a part of the page that is not compiled in");
    return found->text;
}

// The skeleton with each "{{name}}" replaced by the part of that name or by the data. What is put
// in is not looked at again.
std::string assembled(std::string_view report, std::string_view pictures) {
    std::string_view rest = page_part(page_name);
    std::string page;
    for (auto begin = rest.find("{{"); begin != rest.npos; begin = rest.find("{{")) {
        const auto end = rest.find("}}", begin);
        const auto name = rest.substr(begin + 2, end - begin - 2);
        page += rest.substr(0, begin);
        page += name == "report" ? report : name == "pictures" ? pictures : page_part(name);
        rest.remove_prefix(end + 2);
    }
    page += rest;
    return page;
}

// "report/" names the folder "report".
fs::path without_slash(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

} // namespace

fs::path page_file(const fs::path& folder) {
    return without_slash(folder) / page_name;
}

Result<void> check_page_target(const fs::path& folder) {
    const fs::path target = without_slash(folder);
    std::error_code code;
    if (fs::exists(target, code) && !fs::is_directory(target, code)) {
        return Error{fmt::format("--html: {} found, which is a file; a folder was expected",
                                 target.string())};
    }
    const auto writable = AtomicFile::create(fs::exists(target, code) ? page_file(folder) : target);
    return writable ? Result<void>() : writable.error();
}

Result<MadeFolder> MadeFolder::make(const fs::path& folder) {
    std::error_code code;
    const bool is_new = fs::create_directory(folder, code);
    if (code) {
        return Error{
            fmt::format("{}: the folder cannot be made: {}", folder.string(), code.message())};
    }
    return MadeFolder(is_new ? folder : fs::path());
}

MadeFolder::~MadeFolder() {
    std::error_code ignored;
    if (!folder_.empty()) {
        fs::remove(folder_, ignored); // fails where it is not empty
    }
}

Result<PreparedPage> prepare_page(const fs::path& folder, std::string_view json_report,
                                  std::span<const RowPictures> pictures) {
    const auto rows = rows_of_report(json_report);
    if (!rows) {
        return rows.error();
    }
    for (const RowPictures& each : pictures) {
        check(each.row < *rows, "a page with pictures of a row that is not in the report");
        check(each.view != nullptr, "a page with a row without pictures");
    }
    auto made = MadeFolder::make(without_slash(folder));
    if (!made) {
        return made.error();
    }
    const std::string page =
        assembled(safe_in_script(json_report), safe_in_script(pictures_as_json(pictures)));
    auto file = prepare_file(page_file(folder), std::as_bytes(std::span(page)));
    if (!file) {
        return file.error();
    }
    return PreparedPage{std::move(*made), std::move(*file)};
}

Result<void> write_page(const fs::path& folder, std::string_view json_report,
                        std::span<const RowPictures> pictures) {
    auto page = prepare_page(folder, json_report, pictures);
    return page ? page->file.commit() : page.error();
}

} // namespace reljef::bench
