#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/session/log.h"

namespace reljef::cli {

/// Writes messages and progress to stderr.
class ConsoleLog : public session::Log {
public:
    explicit ConsoleLog(bool quiet) : quiet_(quiet) {}

    void message(session::MessageKind kind, std::string_view sentence) override;
    [[nodiscard]] std::unique_ptr<session::Task> start(const std::string& label) override;

private:
    bool quiet_;
};

} // namespace reljef::cli
