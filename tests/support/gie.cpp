#include "tests/support/gie.h"

#include <fstream>
#include <optional>
#include <sstream>

namespace reljef::test {
namespace {

/// All words as numbers; nothing where one is none.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
    std::istringstream words(text.substr(0, text.find('#')));
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
        result += (result.empty() ? "" : " ") + std::string(word[0] == '+' ? "" : "+") + word;
    }
    return result;
}

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
            inverse_ = false;
        } else if (key.starts_with('+')) {
            operation_ += " " + key + rest;
        } else if (key == "direction") {
            inverse_ = rest.find("inverse") != std::string::npos;
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
        const std::string operation = tidy(operation_);
        if (!expected || !accepted_ || operation.find("pipeline") != std::string::npos) {
            return;
        }
        points_.push_back({operation, inverse_ ? *expected : *accepted_,
                           inverse_ ? *accepted_ : *expected, inverse_, number});
    }

    std::string operation_;
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
