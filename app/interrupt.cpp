#include "app/interrupt.h"

#include <csignal>
#include <cstdlib>
#include <ctime>

namespace reljef::app {
namespace {

sigset_t stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

void watch(const std::stop_token& end, std::stop_source source) {
    const sigset_t signals = stop_signals();
    const timespec pause{0, 50'000'000}; // how late the watcher notices the program's end
    while (!end.stop_requested()) {
        const int signal = sigtimedwait(&signals, nullptr, &pause);
        if (signal > 0 && source.stop_requested()) {
            std::_Exit(128 + signal);
        }
        if (signal > 0) {
            source.request_stop();
        }
    }
}

} // namespace

Interrupt::Interrupt() {
    const sigset_t signals = stop_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    watcher_ = std::jthread([source = source_](const std::stop_token& end) { watch(end, source); });
}

} // namespace reljef::app
