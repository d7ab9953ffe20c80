#include "bench/latency/raw_hops.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bus/detail/versions/topic_type.hpp"
#include "bus/detail/versions/transports.hpp"

namespace fathom::test {
namespace {

namespace dds = bus::detail::dds;
namespace rtps = bus::detail::rtps;

constexpr std::uint32_t kDomainOfHops = 97;

using Bytes = std::vector<unsigned char>;

/// So many bytes, as they are.
class BytesType final : public bus::detail::TopicType {
 public:
  BytesType(const char* name, std::size_t size)
      : TopicType(name, static_cast<std::uint32_t>(size), false), size_(size) {}

 private:
  [[nodiscard]] std::size_t encode(const void* data, std::span<char> into) const override {
    std::memcpy(into.data(), static_cast<const Bytes*>(data)->data(), size_);
    return size_;
  }
  void decode(std::span<char> bytes, void* data) const override {
    std::memcpy(static_cast<Bytes*>(data)->data(), bytes.data(), std::min(bytes.size(), size_));
  }
  [[nodiscard]] void* create() const override { return new Bytes(size_); }
  void destroy(void* data) const override { delete static_cast<Bytes*>(data); }
  [[nodiscard]] bus::detail::Digest key(const void* /*data*/, bool /*force_md5*/) const override {
    return {};
  }

  std::size_t size_;
};

/// A participant that finds the others on this machine.
class Presence {
 public:
  Presence() {
    dds::DomainParticipantQos qos;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    udp->non_blocking_send = true;
    udp->maxInitialPeersRange = 32;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports = {udp};
    rtps::Locator_t peer;
    rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, "127.0.0.1", 0, peer);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(kDomainOfHops, qos);
    if (participant_ == nullptr) throw std::runtime_error("no participant");
  }

  dds::DataWriter* writer(const std::string& name, std::size_t bytes) {
    dds::DataWriterQos qos;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 64;
    qos.data_sharing().off();
    auto* publisher = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    auto* made = publisher->create_datawriter(topic(name, bytes), qos);
    if (made == nullptr) throw std::runtime_error("no writer");
    return made;
  }
  dds::DataReader* reader(const std::string& name, std::size_t bytes, dds::DataReaderListener* listener) {
    dds::DataReaderQos qos;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 64;
    qos.data_sharing().off();
    auto* subscriber = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    auto* made = subscriber->create_datareader(topic(name, bytes), qos, listener);
    if (made == nullptr) throw std::runtime_error("no reader");
    return made;
  }

 private:
  dds::Topic* topic(const std::string& name, std::size_t bytes) {
    const dds::TypeSupport type(new BytesType(name.c_str(), bytes));
    type.register_type(participant_);
    return participant_->create_topic(name, name, dds::TOPIC_QOS_DEFAULT);
  }

  dds::DomainParticipant* participant_ = nullptr;
};

/// Hands on what comes.
class Listener final : public dds::DataReaderListener {
 public:
  Listener(std::size_t bytes, std::function<void(const Bytes&)> arrived)
      : buffer_(bytes), arrived_(std::move(arrived)) {}
  void on_data_available(dds::DataReader* reader) override {
    dds::SampleInfo info;
    while (bus::detail::done(reader->take_next_sample(&buffer_, &info))) {
      if (info.valid_data) arrived_(buffer_);
    }
  }

 private:
  Bytes buffer_;
  std::function<void(const Bytes&)> arrived_;
};

int readers_of(const dds::DataWriter& writer) {
  dds::PublicationMatchedStatus status;
  const_cast<dds::DataWriter&>(writer).get_publication_matched_status(status);
  return status.current_count;
}

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

[[noreturn]] void sleep_for_ever() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

struct RawHops::Shared {
  static constexpr std::size_t kMost = 200'000;
  std::atomic<std::int64_t> period_ns{0};  ///< 0: rests
  std::atomic<int> out_readers{0};
  std::atomic<int> back_readers{0};
  std::atomic<std::size_t> rounds{0};
  std::array<double, kMost> round_us{};
};

RawHops::RawHops(std::string name, Way out, Way back)
    : name_(std::move(name)), out_(out), back_(back), shared_(nullptr) {
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  shared_ = new (memory) Shared;
  constexpr int kMiddle_ms = 1000;
  const auto crowd = [this](int readers, void (RawHops::*body)()) {
    for (int i = 0; i < readers - 1; ++i) spawn(i % 2 == 0 ? 0 : 2 * kMiddle_ms, body);
  };
  crowd(out.readers, &RawHops::listen_out);
  crowd(back.readers, &RawHops::listen_back);
  spawn(kMiddle_ms, &RawHops::relay);
  spawn(kMiddle_ms, &RawHops::sender);
}

RawHops::~RawHops() {
  for (const pid_t process : processes_) {
    ::kill(process, SIGKILL);
    (void)waitpid(process, nullptr, 0);
  }
  munmap(shared_, sizeof(Shared));
}

void RawHops::spawn(int milliseconds, void (RawHops::*body)()) {
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process");
  if (process > 0) {
    processes_.push_back(process);
    return;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  (this->*body)();
}

bool RawHops::matched() const {
  return shared_->out_readers == out_.readers && shared_->back_readers == back_.readers;
}

void RawHops::send(double rate_hz) {
  shared_->period_ns = rate_hz > 0.0 ? static_cast<std::int64_t>(1e9 / rate_hz) : 0;
}

std::vector<double> RawHops::take_round_us() {
  const std::size_t now = std::min(shared_->rounds.load(), Shared::kMost);
  const auto& all = shared_->round_us;
  std::vector<double> out(all.begin() + static_cast<std::ptrdiff_t>(taken_),
                          all.begin() + static_cast<std::ptrdiff_t>(now));
  taken_ = now;
  return out;
}

void RawHops::sender() {
  Presence presence;
  Listener listener(back_.bytes, [this](const Bytes& bytes) {
    std::int64_t sent_ns = 0;
    std::memcpy(&sent_ns, bytes.data(), sizeof sent_ns);
    const std::size_t at = shared_->rounds;
    if (at < Shared::kMost) shared_->round_us[at] = 1e-3 * static_cast<double>(now_ns() - sent_ns);
    shared_->rounds = at + 1;
  });
  presence.reader(name_ + "_back", back_.bytes, &listener);
  auto* writer = presence.writer(name_ + "_out", out_.bytes);
  Bytes bytes(out_.bytes);
  auto next = std::chrono::steady_clock::now();
  while (true) {
    shared_->out_readers = readers_of(*writer);
    const std::int64_t period_ns = shared_->period_ns;
    if (period_ns == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      next = std::chrono::steady_clock::now();
      continue;
    }
    const std::int64_t sent_ns = now_ns();
    std::memcpy(bytes.data(), &sent_ns, sizeof sent_ns);
    writer->write(&bytes);
    next += std::chrono::nanoseconds(period_ns);
    std::this_thread::sleep_until(next);
  }
}

void RawHops::relay() {
  Presence presence;
  auto* writer = presence.writer(name_ + "_back", back_.bytes);
  Bytes bytes(back_.bytes);
  Listener listener(out_.bytes, [&](const Bytes& from) {
    std::memcpy(bytes.data(), from.data(), sizeof(std::int64_t));
    writer->write(&bytes);
  });
  presence.reader(name_ + "_out", out_.bytes, &listener);
  while (true) {
    shared_->back_readers = readers_of(*writer);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

void RawHops::listen_out() {
  Presence presence;
  Listener listener(out_.bytes, [](const Bytes&) {});
  presence.reader(name_ + "_out", out_.bytes, &listener);
  sleep_for_ever();
}

void RawHops::listen_back() {
  Presence presence;
  Listener listener(back_.bytes, [](const Bytes&) {});
  presence.reader(name_ + "_back", back_.bytes, &listener);
  sleep_for_ever();
}

}  // namespace fathom::test
