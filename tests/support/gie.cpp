#include "tests/support/gie.h"

#include <fstream>
#include <optional>
#include <sstream>

namespace reljef::test {
namespace {

/// All words as numbers; nothing where one is none.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
    std::string digits = text.substr(0, text.find('#'));
    std::erase(digits, '_'); // "10_018_754.1714"
    std::istringstream words(digits);
    std::vector<double> numbers;
    std::string word;
    while (words >> word) {
        std::size_t end = 0;
        try {
            numbers.push_back(std::stod(word, &end));
        } catch (const std::exception&) {
            return std::nullopt;
        }
        if (end != word.size()) {
            return std::nullopt;
        }
    }
    return numbers.size() >= 2 ? std::optional(numbers) : std::nullopt;
}

/// The words of an operation, each with its plus, one space between them.
std::string tidy(const std::string& text) {
    std::istringstream words(text.substr(0, text.find('#')));
    std::string result;
    std::string word;
    while (words >> word) {
        if (word == "\\") { // the next line goes on
            continue;
        }
        result += (result.empty() ? "" : " ") + std::string(word[0] == '+' ? "" : "+") + word;
    }
    return result;
}

/// Metres: "0.1 mm", "1e-15m"; without a unit metres.
double length_of(const std::string& text) {
    std::istringstream words(text);
    double number = 0.0;
    std::string unit;
    words >> number >> unit;
    return number * (unit == "nm" ? 1e-9 : unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : 1.0);
}

constexpr double usual_tolerance = 0.5e-3; // metres; gie's own

class Reader {
public:
    void take(const std::string& line, int number) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        std::string rest;
        std::getline(words, rest);
        if (key == "operation") {
            operation_ = rest;
            tolerance_ = usual_tolerance;
            inverse_ = false;
        } else if (key.starts_with('+')) {
            operation_ += " " + key + rest;
        } else if (key == "direction") {
            inverse_ = rest.find("inverse") != std::string::npos;
        } else if (key == "tolerance") {
            tolerance_ = length_of(rest);
        } else if (key == "accept") {
            accepted_ = numbers_of(rest);
        } else if (key == "expect") {
            expect(rest, number);
        }
    }
    [[nodiscard]] std::vector<GiePoint> points() && { return std::move(points_); }

private:
    void expect(const std::string& text, int number) {
        const auto expected = numbers_of(text);
        if (expected && accepted_) {
            points_.push_back({tidy(operation_), inverse_ ? *expected : *accepted_,
                               inverse_ ? *accepted_ : *expected, tolerance_, inverse_, number});
        }
    }

    std::string operation_;
    double tolerance_ = usual_tolerance;
    bool inverse_ = false;
    std::optional<std::vector<double>> accepted_;
    std::vector<GiePoint> points_;
};

} // namespace

std::vector<GiePoint> read_gie(const std::filesystem::path& path) {
    std::ifstream stream(path);
    Reader reader;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        reader.take(line, number);
    }
    return std::move(reader).points();
}

} // namespace reljef::test
