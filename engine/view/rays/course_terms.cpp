#include "engine/view/rays/course_terms.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace reljef::view {
namespace {

using terrain::SamplePolynomial;

constexpr int degree = 4;

struct Monomial {
    int x = 0;
    int y = 0;
    int z = 0;
};

constexpr std::array<Monomial, RayCourse::term_count> monomials = [] {
    std::array<Monomial, RayCourse::term_count> all{};
    std::size_t count = 0;
    for (int total = 1; total <= degree; ++total) {
        for (int x = total; x >= 0; --x) {
            for (int y = total - x; y >= 0; --y) {
                all[count++] = {x, y, total - x - y};
            }
        }
    }
    return all;
}();

// Of a monomial among all.
std::size_t index_of(Monomial term) {
    constexpr std::array<std::size_t, degree + 1> first{0, 0, 3, 9, 19}; // of a degree
    const auto less_x = static_cast<std::size_t>(term.y) + static_cast<std::size_t>(term.z);
    return first[static_cast<std::size_t>(term.x) + less_x] + less_x * (less_x + 1) / 2 +
           static_cast<std::size_t>(term.z);
}

double power(double base, int exponent) {
    double product = 1.0;
    for (int i = 0; i < exponent; ++i) {
        product *= base;
    }
    return product;
}

double binomial(int n, int k) {
    double ways = 1.0;
    for (int i = 1; i <= k; ++i) {
        ways = ways * (n - k + i) / i;
    }
    return ways;
}

// Of a polynomial of degree 4, the coefficient around `origin`.
glm::dvec3 shifted_term(const SamplePolynomial& polynomial, Monomial term, glm::dvec3 origin) {
    glm::dvec3 sum(0.0);
    for (int i = term.x; i <= degree; ++i) {
        for (int j = term.y; i + j <= degree; ++j) {
            const int last = std::min(degree - i - j, SamplePolynomial::vertical_degree);
            for (int k = term.z; k <= last; ++k) {
                const double ways = binomial(i, term.x) * binomial(j, term.y) * binomial(k, term.z);
                const glm::dvec3 whole = polynomial.coefficient(i, j, k);
                sum += ways * power(origin.x, i - term.x) * power(origin.y, j - term.y) *
                       power(origin.z, k - term.z) * whole;
            }
        }
    }
    return sum;
}

// Of a symmetric matrix, the largest absolute eigenvalue; by the trigonometric solution of its
// cubic.
double norm(const glm::dmat3& matrix) {
    const double mean = (matrix[0][0] + matrix[1][1] + matrix[2][2]) / 3.0;
    const glm::dmat3 rest = matrix - glm::dmat3(mean);
    double squares = 0.0;
    for (int column = 0; column < 3; ++column) {
        squares += glm::dot(rest[column], rest[column]);
    }
    const double size = std::sqrt(squares / 6.0);
    if (size == 0.0) {
        return std::abs(mean);
    }
    const double cosine = std::clamp(0.5 * glm::determinant(rest / size), -1.0, 1.0);
    const double angle = std::acos(cosine) / 3.0;
    const double largest = mean + 2.0 * size * std::cos(angle);
    const double smallest = mean + 2.0 * size * std::cos(angle + 2.0 * std::numbers::pi / 3.0);
    return std::max(std::abs(largest), std::abs(smallest));
}

glm::dvec3 sum_from(std::size_t first, const CourseTerms& terms, glm::dvec3 direction) {
    glm::dvec3 sum(0.0);
    for (std::size_t term = first; term < monomials.size(); ++term) {
        const auto [x, y, z] = monomials[term];
        sum += power(direction.x, x) * power(direction.y, y) * power(direction.z, z) * terms[term];
    }
    return sum;
}

} // namespace

CourseTerms shifted_terms(const SamplePolynomial& polynomial, glm::dvec3 origin) {
    CourseTerms terms{};
    for (std::size_t term = 0; term < monomials.size(); ++term) {
        terms[term] = shifted_term(polynomial, monomials[term], origin);
    }
    return terms;
}

glm::dvec3 sum_of_terms(const CourseTerms& terms, glm::dvec3 direction) {
    return sum_from(0, terms, direction);
}

glm::dvec3 sum_of_quartic_terms(const CourseTerms& terms, glm::dvec3 direction) {
    return sum_from(index_of({degree, 0, 0}), terms, direction);
}

std::array<glm::dvec3, LightCourse::term_count> terms_along(const CourseTerms& terms,
                                                            glm::dvec3 way) {
    constexpr std::array<std::size_t, degree> first{0, 20, 30, 34}; // of each power
    std::array<glm::dvec3, LightCourse::term_count> along{};
    const auto add = [&](Monomial whole, Monomial part, std::size_t at) {
        const int total = whole.x + whole.y + whole.z - part.x - part.y - part.z;
        const double ways = binomial(whole.x, part.x) * binomial(whole.y, part.y) *
                            binomial(whole.z, part.z) * power(way.x, whole.x - part.x) *
                            power(way.y, whole.y - part.y) * power(way.z, whole.z - part.z);
        along[first[static_cast<std::size_t>(total) - 1] + at] += ways * terms[index_of(whole)];
    };
    for (const Monomial whole : monomials) {
        add(whole, {0, 0, 0}, 0);
        for (const Monomial part : monomials) {
            const bool is_smaller = part.x + part.y + part.z < whole.x + whole.y + whole.z;
            if (is_smaller && part.x <= whole.x && part.y <= whole.y && part.z <= whole.z) {
                add(whole, part, 1 + index_of(part));
            }
        }
    }
    return along;
}

double curvature_at(const RayCourse& course, glm::dvec3 relative, glm::dvec3 metres) {
    const glm::dvec3 at = course.unit_from_relative * relative;
    std::array<glm::dmat3, 3> hessians{};
    for (std::size_t term = 0; term < monomials.size(); ++term) {
        const std::array<int, 3> powers{monomials[term].x, monomials[term].y, monomials[term].z};
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                std::array<int, 3> left = powers;
                double factor = left[static_cast<std::size_t>(a)]--;
                factor *= left[static_cast<std::size_t>(b)]--;
                if (factor == 0.0) {
                    continue;
                }
                const double value =
                    factor * power(at.x, left[0]) * power(at.y, left[1]) * power(at.z, left[2]);
                for (int axis = 0; axis < 3; ++axis) {
                    hessians[static_cast<std::size_t>(axis)][a][b] +=
                        value * course.terms[term][axis];
                }
            }
        }
    }
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double bend =
            norm(glm::transpose(course.unit_from_relative) *
                 hessians[static_cast<std::size_t>(axis)] * course.unit_from_relative);
        square += metres[axis] * metres[axis] * bend * bend;
    }
    return std::sqrt(square);
}

} // namespace reljef::view
