#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "engine/core/check.h"

namespace reljef {

/// One sentence that names the file or option, what was found and what was expected.
struct Error {
    /// usage: unknown or conflicting options. failure: everything else.
    enum class Kind { failure, usage };

    std::string message;
    Kind kind = Kind::failure;
};

/// A file, or part of one, that could not be read. The message names it.
struct FileError {
    std::filesystem::path file;
    std::string message;

    friend bool operator==(const FileError&, const FileError&) = default;
};

inline Error usage_error(std::string message) {
    return {std::move(message), Error::Kind::usage};
}

/// A value or an error. Nothing throws across rooms.
template <class T> class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool has_value() const { return state_.index() == 0; }
    explicit operator bool() const { return has_value(); }

    /// Precondition: has_value().
    T& value() & { return checked(*this); }
    const T& value() const& { return checked(*this); }
    T&& value() && { return std::move(checked(*this)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// Precondition: !has_value().
    [[nodiscard]] const Error& error() const {
        check(!has_value(), "error() of a Result that holds a value");
        return *std::get_if<1>(&state_);
    }

private:
    template <class Self> static auto& checked(Self& self) {
        check(self.has_value(), "value() of a Result that holds an error");
        return *std::get_if<0>(&self.state_);
    }

    std::variant<T, Error> state_;
};

/// Success or an error.
template <> class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    [[nodiscard]] bool has_value() const { return !error_.has_value(); }
    explicit operator bool() const { return has_value(); }

    /// Precondition: !has_value().
    [[nodiscard]] const Error& error() const {
        check(error_.has_value(), "error() of a Result that holds a value");
        return *error_;
    }

private:
    std::optional<Error> error_;
};

} // namespace reljef
