#include "tests/bench/report/made_figures.h"

#include "tests/bench/report/made_results.h"

namespace reljef::test {

bench::FigureTable made_figures() {
    using namespace bench::columns;
    bench::FigureColumn ms = less("/ms/median", "median", "ms");
    ms.noise = "/noise";
    bench::FigureColumn value = less("/value", "value");
    value.limit = "/limit";
    bench::FigureTable table;
    table.suite = "peers";
    table.environment = made_results().environment;
    table.settings = {{"quick", true}, {"size", "64x48"}};
    table.columns = {group("/scene", "terrain"),
                     name("/what", "what"),
                     ms,
                     detail(plain("/noise", "noise")),
                     less("/error/px", "error", "px", 3),
                     more("/rate", "rate"),
                     value,
                     plain("/limit", "limit"),
                     plain("/bytes", "sent", "bytes", 1)};
    table.rows = {{"natural", "ours", 10.0, 0.05, 0.5, 100, 1.0, 3.0, 2'500'000},
                  {"natural", "theirs, too", 20.0, 0.05, nullptr, 50, 1.0, 3.0, nullptr},
                  {"urban", "ours", 12.0, 0.05, 0.25, 80, 2.0, 3.0, nullptr}};
    table.notes = {"A note."};
    return table;
}

} // namespace reljef::test
