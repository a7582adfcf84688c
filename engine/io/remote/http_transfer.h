#pragma once

#include <array>
#include <memory>
#include <string>

#include <cpl_string.h>
#include <curl/curl.h>

#include "engine/io/remote/http_client.h"

namespace reljef::io {

/// One part of a file on its way: a request, its redirects and its retries.
class HttpTransfer {
public:
    HttpTransfer(std::string url, ByteRange range);
    HttpTransfer(const HttpTransfer&) = delete;
    HttpTransfer& operator=(const HttpTransfer&) = delete;

    /// Prepares the next request. The handle's CURLOPT_PRIVATE is this transfer.
    CURL* prepare();
    void set_outcome(CURLcode code) { code_ = code; }

    enum class Next { finished, request, retry };
    /// Evaluates the answer. A redirect that is not followed and an unusable answer are errors.
    Result<Next> evaluate();
    /// The error after which the request must be repeated.
    [[nodiscard]] const std::string& problem() const { return problem_; }

    /// Bytes that came, with those of failed requests.
    [[nodiscard]] std::size_t received() const { return received_; }
    HttpPart take() { return std::move(part_); }

private:
    static std::size_t on_bytes(char* bytes, std::size_t size, std::size_t count, void* self);
    static curl_socket_t open_public(void* self, curlsocktype purpose, curl_sockaddr* address);
    static int before_request(void* self, char* remote, char* local, int remote_port,
                              int local_port);
    template <class Value> void set(CURLoption option, Value value);
    void set_users_options();
    void set_redirect_options();
    std::size_t add(const char* bytes, std::size_t count);
    [[nodiscard]] std::string header(const char* name) const;
    Result<Next> follow_redirect();
    Result<Next> check_answer(long status);
    Result<Next> check_part(long status);

    struct EasyCloser {
        void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
    };
    struct ListCloser {
        void operator()(curl_slist* list) const { curl_slist_free_all(list); }
    };

    ByteRange range_;
    std::string target_; ///< the address, or where it was redirected to
    int redirects_ = 0;
    std::string refused_address_; ///< of a redirect
    std::unique_ptr<curl_slist, ListCloser> headers_;
    std::unique_ptr<CURL, EasyCloser> easy_;
    CURLcode code_ = CURLE_OK;
    std::array<char, CURL_ERROR_SIZE> curl_error_{};
    bool too_long_ = false;
    std::size_t received_ = 0;
    HttpPart part_;
    std::string problem_;
};

} // namespace reljef::io
