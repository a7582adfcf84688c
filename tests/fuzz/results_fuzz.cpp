// Results of reljef-bench (JSON): what is read can be written, and read again as the same.
#include "bench/report/report_json.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace reljef;
    static const fuzz::InputFolder folder;
    const auto read = bench::read_json_report(folder.write("r.json", fuzz::text_of(data, size)));
    if (read) {
        const std::string written = bench::json_report(*read);
        const auto again = bench::read_json_report(folder.write("w.json", written));
        fuzz::expect(static_cast<bool>(again), "results that can be read again");
        fuzz::expect(bench::json_report(*again) == written, "the same results again");
    }
    return 0;
}
