#include "bench/findings/judgement.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace reljef::bench {
namespace {

double share_of(double part, double whole) {
    return whole == 0.0 ? 0.0 : part / whole;
}

// A quotient of two measured numbers, to first order. A noise floor is already that of a difference
// of two rows of its run; spreads are independent.
Number quotient(const Number& above, const Number& below) {
    const double value = above.value / below.value;
    return {value, value * std::max(share_of(above.noise, above.value), below.noise / below.value),
            value * std::hypot(share_of(above.spread, above.value), below.spread / below.value)};
}

std::optional<Number> computed(Figure::Form form, const Number& number,
                               const std::optional<Number>& base) {
    switch (form) {
    case Figure::Form::plain:
    case Figure::Form::constant:
        return number;
    case Figure::Form::rate:
        return quotient({1000.0}, number);
    case Figure::Form::ratio: {
        const auto found =
            base && base->value > 0.0 ? std::optional(quotient(number, *base)) : std::nullopt;
        return found && std::isfinite(found->value) ? found : std::nullopt;
    }
    case Figure::Form::drop:
        if (!base) {
            return {};
        }
        const Number kept = quotient(*base, number);
        return Number{100.0 * (1.0 - kept.value), 100.0 * kept.noise, 100.0 * kept.spread};
    }
    return {};
}

enum class Place { inside, outside, open };

Place place_of(const Number& number, const Range& range) {
    const double low = number.value - number.uncertainty();
    const double high = number.value + number.uncertainty();
    if (low >= range.low && high <= range.high) {
        return Place::inside;
    }
    return low > range.high || high < range.low ? Place::outside : Place::open;
}

} // namespace

std::string_view to_string(Finding verdict) {
    switch (verdict) {
    case Finding::confirmed:
        return "confirmed";
    case Finding::refuted:
        return "refuted";
    case Finding::depends:
        return "depends";
    case Finding::open:
        return "within noise";
    case Finding::answered:
        return "answered";
    case Finding::not_measured:
        return "not measured yet";
    }
    return "";
}

Result<std::optional<Number>> number_of(const Figure& figure, const CommittedResults& results) {
    if (figure.form == Figure::Form::constant) {
        return std::optional(Number{figure.constant.value, figure.constant.uncertainty});
    }
    auto number = results.number(figure.row, figure.quantity);
    if (!number || !*number) {
        return number;
    }
    std::optional<Number> base;
    if (figure.base) {
        const auto found = results.number(*figure.base, figure.quantity);
        if (!found) {
            return found.error();
        }
        base = *found;
    }
    return computed(figure.form, **number, base);
}

Finding verdict_of(std::span<const Figure> figures,
                   std::span<const std::optional<Number>> numbers) {
    check(figures.size() == numbers.size(), "a number for each figure");
    bool all_inside = true;
    bool all_outside = true;
    bool none_outside = true;
    for (std::size_t i = 0; i < figures.size(); ++i) {
        if (!numbers[i]) {
            return Finding::not_measured;
        }
        const Place place = place_of(*numbers[i], figures[i].expected);
        all_inside = all_inside && place == Place::inside;
        all_outside = all_outside && place == Place::outside;
        none_outside = none_outside && place != Place::outside;
    }
    if (figures.empty()) {
        return Finding::not_measured;
    }
    if (all_inside || all_outside) {
        return all_inside ? Finding::confirmed : Finding::refuted;
    }
    return none_outside ? Finding::open : Finding::depends;
}

Result<Judgement> judge(const Conclusion& conclusion, const CommittedResults& results) {
    Judgement judgement;
    for (const Figure& figure : conclusion.figures) {
        const auto number = number_of(figure, results);
        if (!number) {
            return number.error();
        }
        judgement.numbers.push_back(*number);
    }
    judgement.verdict = verdict_of(conclusion.figures, judgement.numbers);
    if (conclusion.rule.empty() && judgement.verdict != Finding::not_measured) {
        judgement.verdict = Finding::answered;
    }
    return judgement;
}

} // namespace reljef::bench
