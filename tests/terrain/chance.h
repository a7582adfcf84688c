#pragma once

#include <cmath>
#include <random>

#include <glm/vec2.hpp>

#include "engine/core/grid.h"

namespace reljef::test {

/// Random numbers, the same for the same seed.
class Chance {
public:
    explicit Chance(unsigned seed) : random_(seed) {}

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    bool one_in(int n) { return whole(1, n) == 1; }

    /// A place in or around the grid; now and then exactly on a line between cells or on a vertex.
    glm::dvec2 place(const Grid<float>& heights, double beyond) {
        glm::dvec2 at{between(-beyond, heights.cols() - 1 + beyond),
                      between(-beyond, heights.rows() - 1 + beyond)};
        at.x = one_in(4) ? std::round(at.x) : at.x;
        at.y = one_in(4) ? std::round(at.y) : at.y;
        return at;
    }

private:
    std::mt19937 random_;
};

} // namespace reljef::test
