#include "bench/page/page.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/page/page_parts.h"
#include "bench/report/report_json.h"

namespace reljef::bench {
namespace fs = std::filesystem;
namespace {

using PageJson = nlohmann::ordered_json;

constexpr std::string_view page_name = "index.html";
constexpr std::string_view stress_skeleton = "stress.html";
constexpr std::string_view figures_skeleton = "document.html";

struct Album {
    std::vector<std::string> uris;
    std::vector<std::pair<const RowView::File*, std::size_t>> truths; // with their indices
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

PageJson add_pictures_of(Album& album, std::size_t row, const RowView& view) {
    PageJson pictures{{"row", row},
                      {"width", view.size.x},
                      {"height", view.size.y},
                      {"shown", add_picture(album, "image/jpeg", view.shown)},
                      {"truth", add_truth(album, *view.truth)},
                      {"heat", add_picture(album, "image/png", view.heat)}};
    if (!view.work.empty()) {
        pictures["work"] = add_picture(album, "image/png", view.work);
    }
    return pictures;
}

std::string css_color(Rgba8 color) {
    return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b);
}

PageJson scale_of_errors() {
    const auto scale = heat_scale();
    PageJson colors = PageJson::array();
    std::transform(scale.begin(), scale.end(), std::back_inserter(colors), css_color);
    return {
        {"low", heat_low_px},   {"high", heat_high_px},   {"unbounded", css_color(heat_unbounded)},
        {"work_low", work_low}, {"work_high", work_high}, {"colors", std::move(colors)}};
}

std::string pictures_as_json(const std::vector<Row>& rows) {
    Album album;
    PageJson pictures = PageJson::array();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].view) {
            pictures.push_back(add_pictures_of(album, i, *rows[i].view));
        }
    }
    return PageJson{{"scale", scale_of_errors()},
                    {"rows", std::move(pictures)},
                    {"images", std::move(album.uris)}}
        .dump();
}

// Escapes "<", so that no string can end the script element. JSON has "<" in strings only.
std::string safe_in_script(std::string_view json) {
    std::string safe;
    for (const char c : json) {
        safe += c == '<' ? std::string_view("\\u003c") : std::string_view(&c, 1);
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

// Replaces each "{{name}}" of the skeleton by the part of that name or by the data, once.
std::string assembled(std::string_view skeleton, std::string_view report,
                      std::string_view pictures) {
    std::string_view rest = page_part(skeleton);
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

fs::path without_slash(const fs::path& folder) {
    return folder.has_filename() ? folder : folder.parent_path();
}

Result<PreparedPage> prepare(const fs::path& folder, const std::string& page) {
    auto made = make_folder(without_slash(folder));
    if (!made) {
        return made.error();
    }
    auto file = prepare_file(page_file(folder), std::as_bytes(std::span(page)));
    if (!file) {
        return file.error();
    }
    return PreparedPage{std::move(*made), std::move(*file)};
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

Result<std::shared_ptr<const fs::path>> make_folder(const fs::path& folder) {
    std::error_code code;
    const bool is_new = fs::create_directory(folder, code);
    if (code) {
        return Error{
            fmt::format("{}: the folder cannot be made: {}", folder.string(), code.message())};
    }
    return std::shared_ptr<const fs::path>(new fs::path(folder), [is_new](const fs::path* made) {
        std::error_code ignored;
        if (is_new) {
            fs::remove(*made, ignored); // fails if it is not empty
        }
        delete made;
    });
}

Result<PreparedPage> prepare_page(const fs::path& folder, const Results& results) {
    return prepare(folder, assembled(page_name, safe_in_script(json_report(results)),
                                     safe_in_script(pictures_as_json(results.rows))));
}

Result<PreparedPage> prepare_page(const fs::path& folder, const FigureTable& table) {
    const std::string_view skeleton = table.suite == "stress" ? stress_skeleton : figures_skeleton;
    return prepare(folder, assembled(skeleton, safe_in_script(figure_json(table)), {}));
}

std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text = fmt::format("data:{};base64,", media_type);
    for (std::size_t begin = 0; begin < bytes.size(); begin += 3) { // three bytes, four digits
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - begin);
        std::size_t bits = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            bits = (bits << 8U) | (i < count ? std::to_integer<std::size_t>(bytes[begin + i]) : 0U);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            text += i <= count ? digits[(bits >> (18U - 6U * i)) & 63U] : '=';
        }
    }
    return text;
}

} // namespace reljef::bench
