// Results of reljef-bench (JSON): what is read can be written, and read again as the same.
#include <variant>

#include "bench/report/document.h"
#include "bench/report/report_json.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

static std::string written_as(const bench::Document& document) {
    const auto* const table = std::get_if<bench::FigureTable>(&document);
    return table != nullptr ? bench::figure_json(*table)
                            : bench::json_report(std::get<bench::Results>(document));
}

void results_target(std::string_view input) {
    static const InputFolder folder;
    const auto read = bench::read_document(folder.write("r.json", input));
    if (read) {
        const std::string written = written_as(*read);
        const auto again = bench::read_document(folder.write("w.json", written));
        expect(static_cast<bool>(again), "results that can be read again");
        expect(written_as(*again) == written, "the same results again");
    }
}

} // namespace reljef::fuzz
