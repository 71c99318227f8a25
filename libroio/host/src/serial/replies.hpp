#ifndef ROIO_SERIAL_REPLIES_HPP
#define ROIO_SERIAL_REPLIES_HPP

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <roio/bridge.hpp>
#include <string>
#include <system_error>
#include <utility>

namespace roio::serial {

/// Requests that the program has begun and not taken the reply of yet. Not for two threads at once.
class Replies {
 public:
  static constexpr std::size_t max_requests = 64;

  /// @return the request's number, from 1.
  /// @throws std::system_error std::errc::no_buffer_space, about `name`.
  std::uint32_t begin(const std::string& name) {
    if (under_way_ + done_.size() >= max_requests) {
      throw std::system_error(std::make_error_code(std::errc::no_buffer_space),
                              name + ": " + std::to_string(max_requests) +
                                  " requests whose replies have not been taken");
    }
    ++under_way_;
    return ++last_;
  }
  void finish(BridgeReply reply) {
    --under_way_;
    done_.push_back(std::move(reply));
  }
  std::optional<BridgeReply> take() {
    if (done_.empty()) {
      return std::nullopt;
    }
    std::optional<BridgeReply> reply(std::move(done_.front()));
    done_.pop_front();
    return reply;
  }

 private:
  std::uint32_t last_ = 0;
  std::size_t under_way_ = 0;
  std::deque<BridgeReply> done_;
};

}  // namespace roio::serial

#endif
