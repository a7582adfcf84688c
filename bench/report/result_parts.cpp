#include "bench/report/result_parts.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "app/cli/shard_option.h"
#include "bench/report/report_json.h"

namespace reljef::bench {
namespace {

constexpr std::string_view number_word = "%d";

bool is_same(const Environment& a, const Environment& b) {
    return a.renderer == b.renderer && a.gl == b.gl && a.context == b.context &&
           a.threads == b.threads && a.cpu == b.cpu && a.commit == b.commit;
}

template <class Value> void append(std::vector<Value>& all, std::vector<Value>& more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

Result<void> check_parts(const std::vector<Results>& parts) {
    const int count = parts.front().shard.count;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Shard expected{static_cast<int>(i), count};
        if (parts[i].shard != expected) {
            return Error{fmt::format("part {} found, {} was expected",
                                     cli::shard_text(parts[i].shard), cli::shard_text(expected))};
        }
        if (!is_same(parts[i].environment, parts.front().environment)) {
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

} // namespace

std::filesystem::path part_file(const std::filesystem::path& name, const Shard& shard) {
    std::string text = name.string();
    if (const auto place = text.find(number_word); place != std::string::npos) {
        text.replace(place, number_word.size(), std::to_string(shard.index));
    }
    return text;
}

Result<Results> merged(std::vector<Results> parts) {
    if (parts.empty()) {
        return Error{"no parts found, some were expected"};
    }
    std::sort(parts.begin(), parts.end(),
              [](const Results& a, const Results& b) { return a.shard.index < b.shard.index; });
    if (auto good = check_parts(parts); !good) {
        return good.error();
    }
    Results all = std::move(parts.front());
    all.shard = {};
    for (std::size_t i = 1; i < parts.size(); ++i) {
        append(all.rows, parts[i].rows);
        append(all.fronts, parts[i].fronts);
        append(all.left_out, parts[i].left_out);
        append(all.notes, parts[i].notes);
        all.stopped = all.stopped ? all.stopped : parts[i].stopped;
        all.failed = all.failed || parts[i].failed;
    }
    return all;
}

Result<Results> read_result_parts(const std::filesystem::path& name) {
    if (name.string().find(number_word) == std::string::npos) {
        return read_json_report(name);
    }
    std::vector<Results> parts;
    int count = 1;
    for (int index = 0; index < count; ++index) {
        auto part = read_json_report(part_file(name, {index, count}));
        if (!part) {
            return part.error();
        }
        count = index == 0 ? part->shard.count : count;
        parts.push_back(std::move(*part));
    }
    auto all = merged(std::move(parts));
    return all ? std::move(all) : Error{fmt::format("{}: {}", name.string(), all.error().message)};
}

} // namespace reljef::bench
