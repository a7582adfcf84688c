// Results of reljef-bench (JSON): what is read can be written, and read again as the same.
#include "bench/report/report_json.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void results_target(std::string_view input) {
    static const InputFolder folder;
    const auto read = bench::read_json_report(folder.write("r.json", input));
    if (read) {
        const std::string written = bench::json_report(*read);
        const auto again = bench::read_json_report(folder.write("w.json", written));
        expect(static_cast<bool>(again), "results that can be read again");
        expect(bench::json_report(*again) == written, "the same results again");
    }
}

} // namespace reljef::fuzz
