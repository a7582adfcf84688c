#include "engine/io/remote/read_scope.h"

#include <utility>

namespace reljef::io {
namespace {

thread_local const ReadScope* innermost_scope = nullptr;

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

int continues_reading(double /*fraction*/, const char* /*message*/, void* /*data*/) {
    return ReadScope::stop_requested() ? 0 : 1;
}

} // namespace reljef::io
