#include "bench/report/result_parts.h"

#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "app/cli/shard_option.h"
#include "bench/report/report_json.h"

namespace reljef::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view number_word = "%d";

template <class Value> void append(std::vector<Value>& all, std::vector<Value>& more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

// Part I of N has the items I, I+N, I+2N, …
template <class Value> std::vector<Value> in_order_of_items(std::vector<std::vector<Value>> parts) {
    std::vector<Value> all;
    std::size_t added = 1;
    for (std::size_t place = 0; added > 0; ++place) {
        added = 0;
        for (std::vector<Value>& part : parts) {
            if (place < part.size()) {
                all.push_back(std::move(part[place]));
                ++added;
            }
        }
    }
    return all;
}

// The rows of each scene and pose, the items of a part. The null row is the last one.
std::vector<std::vector<Row>> items_of(std::vector<Row>&& rows) {
    std::vector<std::vector<Row>> items;
    for (Row& row : rows) {
        const Row* const before = items.empty() ? nullptr : &items.back().back();
        if (before == nullptr || before->null_row || before->test != row.test ||
            before->scene != row.scene || before->pose != row.pose) {
            items.emplace_back();
        }
        items.back().push_back(std::move(row));
    }
    return items;
}

} // namespace

bool names_parts(const fs::path& name) {
    return name.string().find(number_word) != std::string::npos;
}

fs::path part_file(const fs::path& name, const Shard& shard) {
    std::string text = name.string();
    if (const auto place = text.find(number_word); place != std::string::npos) {
        text.replace(place, number_word.size(), std::to_string(shard.index));
    }
    return text;
}

std::vector<fs::path> part_files(const fs::path& name) {
    if (!names_parts(name)) {
        return {name};
    }
    std::vector<fs::path> files;
    std::error_code ignored;
    const auto next = [&] {
        const int index = static_cast<int>(files.size());
        return part_file(name, {index, index + 1});
    };
    for (fs::path file = next(); fs::exists(file, ignored); file = next()) {
        files.push_back(std::move(file));
    }
    return files;
}

Result<void> check_whole(const fs::path& name, const Shard& first) {
    std::error_code ignored;
    const fs::path second = part_file(name, {1, 2});
    return first.is_whole() && fs::exists(second, ignored)
               ? Error{fmt::format("{}: a whole run found beside {}, a part that names its shard "
                                   "was expected",
                                   part_file(name, {0, 2}).string(), second.string())}
               : Result<void>();
}

Result<void> check_origins(const std::vector<PartOrigin>& parts) {
    if (parts.empty()) {
        return Error{"no parts found, some were expected"};
    }
    const int count = parts.front().shard.count;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Shard expected{static_cast<int>(i), count};
        if (parts[i].shard != expected) {
            return Error{fmt::format("part {} found, {} was expected",
                                     cli::shard_text(parts[i].shard), cli::shard_text(expected))};
        }
        if (parts[i].environment != parts.front().environment) {
            return Error{fmt::format("part {} was measured in another environment than part {}, "
                                     "the same was expected",
                                     cli::shard_text(expected),
                                     cli::shard_text(parts.front().shard))};
        }
    }
    return static_cast<int>(parts.size()) == count
               ? Result<void>()
               : Error{fmt::format("{} parts found, {} were expected", parts.size(), count)};
}

Result<Results> merged(std::vector<Results> parts) {
    auto run = whole_run(std::move(parts));
    if (!run) {
        return run.error();
    }
    Results all;
    all.environment = run->front().environment;
    all.settings = run->front().settings;
    std::vector<std::vector<std::vector<Row>>> items;
    std::vector<std::vector<Front>> fronts;
    for (Results& part : *run) {
        items.push_back(items_of(std::move(part.rows)));
        fronts.push_back(std::move(part.fronts));
        append(all.left_out, part.left_out);
        append(all.notes, part.notes);
        all.stopped = all.stopped ? all.stopped : part.stopped;
        all.failed = all.failed || part.failed;
    }
    for (std::vector<Row>& item : in_order_of_items(std::move(items))) {
        append(all.rows, item);
    }
    all.fronts = in_order_of_items(std::move(fronts));
    return all;
}

Result<Results> read_result_parts(const fs::path& name) {
    if (!names_parts(name)) {
        return read_json_report(name);
    }
    auto parts = read_parts(name, read_json_report);
    if (!parts) {
        return parts.error();
    }
    auto all = merged(std::move(*parts));
    return all ? std::move(all) : Error{fmt::format("{}: {}", name.string(), all.error().message)};
}

} // namespace reljef::bench
