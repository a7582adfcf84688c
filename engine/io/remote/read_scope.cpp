#include "engine/io/remote/read_scope.h"

#include <chrono>
#include <optional>
#include <utility>

namespace reljef::io {
namespace {

using Clock = std::chrono::steady_clock;

thread_local const ReadScope* innermost_scope = nullptr;
thread_local std::optional<Clock::time_point> read_begin;

} // namespace

ReadScope::ReadScope(std::stop_token stop) : stop_(std::move(stop)), outer_(innermost_scope) {
    innermost_scope = this;
}

ReadScope::~ReadScope() {
    innermost_scope = outer_;
}

bool ReadScope::stop_requested() {
    for (const ReadScope* scope = innermost_scope; scope != nullptr; scope = scope->outer_) {
        if (scope->stop_.stop_requested()) {
            return true;
        }
    }
    return false;
}

ReadDeadline::ReadDeadline() : is_outermost_(!read_begin) {
    read_begin = read_begin.value_or(Clock::now());
}

ReadDeadline::~ReadDeadline() {
    if (is_outermost_) {
        read_begin.reset();
    }
}

double ReadDeadline::seconds() {
    return read_begin ? std::chrono::duration<double>(Clock::now() - *read_begin).count() : 0.0;
}

int continues_reading(double /*fraction*/, const char* /*message*/, void* /*data*/) {
    return ReadScope::stop_requested() ? 0 : 1;
}

} // namespace reljef::io
