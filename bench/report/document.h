#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "bench/report/figure_table.h"
#include "bench/report/results.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// Results of any suite: rows of techniques, or rows with columns.
using Document = std::variant<Results, FigureTable>;

/// "tables", "peers"; empty if earlier versions wrote it without a row.
std::string suite_of(const Document& document);

/// Reads what json_report() or figure_json() wrote. Fails as read_report().
Result<Document> read_document(const std::filesystem::path& file);

/// Reads results; if the name has "%d", all parts ("part-%d.json"), as one run. Rows with columns
/// follow each other in the order of the parts. Fails as read_document(), if the parts are no run,
/// or are of different suites or columns.
Result<Document> read_document_parts(const std::filesystem::path& name);

} // namespace reljef::bench
