#include <atomic>
#include <span>
#include <string>
#include <thread>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "bench/doors/listeners.hpp"
#include "bus/cdr.hpp"
#include "samples/nav_state.hpp"

namespace fathom::test {
namespace {

namespace net = boost::asio;
namespace websocket = boost::beast::websocket;

class FoxgloveListener final : public Listener {
 public:
  FoxgloveListener(int port, Arrivals& arrivals) : port_(port), arrivals_(arrivals), socket_(context_) {
    thread_ = std::thread([this] { run(); });
  }
  ~FoxgloveListener() override {
    stop_ = true;
    boost::system::error_code ignored;
    socket_.next_layer().shutdown(net::ip::tcp::socket::shutdown_both, ignored);
    thread_.join();
  }
  [[nodiscard]] bool connected() const override { return subscribed_; }

 private:
  bool connect() {
    boost::system::error_code error;
    socket_.next_layer().connect({net::ip::address_v4::loopback(), static_cast<std::uint16_t>(port_)}, error);
    if (error) {
      socket_.next_layer().close(error);
      return false;
    }
    socket_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(boost::beast::http::field::sec_websocket_protocol, "foxglove.websocket.v1");
    }));
    socket_.handshake("127.0.0.1:" + std::to_string(port_), "/", error);
    return !error;
  }
  void run() {
    while (!stop_ && !connect()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    boost::beast::flat_buffer buffer;
    boost::system::error_code error;
    while (!stop_) {
      buffer.clear();
      socket_.read(buffer, error);
      if (error) return;
      const TimeNs now_ns = clock_.utc_ns();
      const std::span bytes(static_cast<const std::uint8_t*>(buffer.data().data()), buffer.size());
      if (socket_.got_text()) {
        subscribe(std::string(bytes.begin(), bytes.end()));
      } else {
        heard(bytes, now_ns);
      }
    }
  }
  void subscribe(const std::string& text) {
    const auto said = nlohmann::json::parse(text, nullptr, false);
    if (said.value("op", "") != "advertise") return;
    for (const auto& channel : said.at("channels")) {
      if (channel.at("topic") != "fathom/v1/nav_state") continue;
      const nlohmann::json wish{{"op", "subscribe"},
                                {"subscriptions", {{{"id", 1}, {"channelId", channel.at("id")}}}}};
      boost::system::error_code error;
      socket_.write(net::buffer(wish.dump()), error);
      subscribed_ = !error;
    }
  }
  void heard(std::span<const std::uint8_t> message, TimeNs now_ns) {
    constexpr std::size_t kHead = 13;  // op, subscription, time
    if (message.size() <= kHead) return;
    if (const auto state = bus::from_cdr<NavState>(message.subspan(kHead)))
      arrivals_.heard(Arrivals::key(state->header.stamp_ns), now_ns);
  }

  SystemClock clock_;
  int port_;
  Arrivals& arrivals_;
  net::io_context context_;
  websocket::stream<net::ip::tcp::socket> socket_;
  std::atomic<bool> subscribed_ = false;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Listener> hear_foxglove(int port, Arrivals& arrivals) {
  return std::make_unique<FoxgloveListener>(port, arrivals);
}

}  // namespace fathom::test
