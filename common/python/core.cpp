#include "python/core.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "python/events.hpp"
#include "python/values.hpp"

namespace fathom::python {
namespace {

// How long a waiting call looks away from signals.
constexpr double kSlice_s = 0.1;
constexpr std::uint32_t kMostDomain = 232;

/// Runs `work` without the interpreter's lock. Not by a destructor: when the interpreter has ended meanwhile
/// it ends this thread where the lock is asked for, by an exception that no destructor lets pass.
template <class Work>
void without_lock(Work work) {
  PyThreadState* thread = PyEval_SaveThread();
  std::exception_ptr failure;
  try {
    work();
  } catch (const std::exception&) {
    failure = std::current_exception();
  }
  PyEval_RestoreThread(thread);
  if (failure) std::rethrow_exception(failure);
}

[[noreturn]] void wait_for_the_end() {
  PyEval_SaveThread();
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

template <class T>
py::object or_none(const std::optional<T>& value) {
  return value ? py::cast(*value) : py::none();
}

bool is_address(const std::string& text) {
  in_addr parsed{};
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
}

bool is_endpoint(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || !is_address(text.substr(0, colon))) return false;
  std::uint16_t port = 0;
  const auto [rest, error] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), port);
  return error == std::errc() && rest == text.data() + text.size() && port != 0;
}

void check_each(const std::vector<std::string>& texts, const std::string& where,
                bool (*fits)(const std::string&), const char* expected) {
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!fits(texts[i])) wrong_value(where + "[" + std::to_string(i) + "]", expected, text_of(texts[i]));
  }
}

/// What can be told without the network is a ValueError.
void check(const ClientOptions& options) {
  if (options.domain > kMostDomain) {
    wrong_value("Client.domain", "an int from 0 to 232", py::int_(options.domain));
  }
  for (const auto& [what, name] :
       {std::pair("vehicle", &options.vehicle), std::pair("name", &options.name)}) {
    if (name->size() > Name::kCapacity) {
      wrong_value(std::string("Client.") + what, "at most 31 bytes of UTF-8", text_of(*name));
    }
  }
  if (options.interfaces.empty()) {
    wrong_value("Client.interfaces", "at least one IPv4 address of this host", py::list());
  }
  constexpr const char* kAddress = "an IPv4 address such as 127.0.0.1";
  check_each(options.interfaces, "Client.interfaces", is_address, kAddress);
  check_each(options.peers, "Client.peers", is_address, kAddress);
  check_each(options.discovery_servers, "Client.discovery_servers", is_endpoint,
             "an IPv4 address and a port such as 192.168.2.1:11811");
}

}  // namespace

struct Core::Impl {
  std::shared_ptr<const Clock> clock;
  Events events;

  std::mutex mutex;  ///< of all that follows
  std::condition_variable unused;
  int uses = 0;
  bool closed = false;
  std::thread::id exiting;  ///< the thread that ends the interpreter
  std::unique_ptr<Client> client;
};

/// A call under way: the client stays until it is over. Throws when the client is closed.
class Core::Use {
 public:
  struct Closed : std::runtime_error {
    using std::runtime_error::runtime_error;
  };
  explicit Use(const Core& core) : impl_(*core.impl_) {
    if (core.of_another_process()) {
      throw std::runtime_error("Client: was made by another process, expected one of this process");
    }
    std::unique_lock lock(impl_.mutex);
    if (impl_.closed) {
      if (impl_.exiting != std::thread::id{} && impl_.exiting != std::this_thread::get_id()) {
        lock.unlock();
        wait_for_the_end();
      }
      throw Closed("Client: is closed");
    }
    ++impl_.uses;
  }
  ~Use() {
    {
      const std::lock_guard lock(impl_.mutex);
      --impl_.uses;
    }
    impl_.unused.notify_all();
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;
  Client* operator->() const { return impl_.client.get(); }

 private:
  Impl& impl_;
};

Core::Core(const ClientOptions& options, std::shared_ptr<const Clock> clock) : process_(::getpid()) {
  check(options);
  auto impl = std::make_unique<Impl>();
  impl->clock = std::move(clock);
  ClientOptions with_clock = options;
  with_clock.clock = impl->clock.get();
  without_lock([&] { impl->client = std::make_unique<Client>(with_clock); });
  impl_ = impl.release();
}

Core::~Core() {
  if (of_another_process()) return;
  close(false);
  delete impl_;
}

bool Core::of_another_process() const {
  return ::getpid() != process_;
}

std::optional<NavState> Core::latest() const {
  return Use(*this)->latest();
}

double Core::age_s() const {
  return Use(*this)->age_s();
}

NavHealth Core::health() const {
  return Use(*this)->health();
}

std::optional<AlignmentStatus> Core::alignment() const {
  return Use(*this)->alignment();
}

std::optional<MonitorStatus> Core::monitor() const {
  return Use(*this)->monitor();
}

void Core::publish_route(const Route& route) {
  Use(*this)->publish_route(route);
}

std::optional<NavState> Core::wait_next(double timeout_s) {
  if (!(timeout_s >= 0.0))
    wrong_value("Client.wait_next: timeout_s", "seconds, 0 or more", py::float_(timeout_s));
  const auto began = std::chrono::steady_clock::now();
  for (bool waited = false;; waited = true) {
    std::optional<NavState> state;
    const double left_s =
        timeout_s - std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    try {
      const Use client(*this);
      without_lock([&] { state = client->wait_next(std::clamp(left_s, 0.0, kSlice_s)); });
    } catch (const Use::Closed&) {
      if (waited) return std::nullopt;  // it was closed meanwhile: nothing comes any more
      throw;
    }
    if (state) return state;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (left_s <= kSlice_s) return std::nullopt;
  }
}

/// Looks for somebody who takes it, and up for Ctrl-C in between.
template <class Give>
void Core::give(const char* what, double timeout_s, Give give) {
  if (!(timeout_s >= 0.0))
    wrong_value(std::string(what) + ": timeout_s", "seconds, 0 or more", py::float_(timeout_s));
  const auto began = std::chrono::steady_clock::now();
  for (;;) {
    const double left_s =
        timeout_s - std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    try {
      const Use client(*this);
      without_lock([&] { give(*client.operator->(), std::clamp(left_s, 0.0, kSlice_s)); });
      return;
    } catch (const NobodyListens&) {
      if (left_s <= kSlice_s) throw;
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

void Core::order(const Command& command, double timeout_s) {
  give("Client.order", timeout_s, [&](Client& client, double slice_s) { client.order(command, slice_s); });
}

void Core::tell(const FixSample& fix, double timeout_s) {
  give("Client.tell_fix", timeout_s, [&](Client& client, double slice_s) { client.tell(fix, slice_s); });
}

void Core::hear_states(bool wanted) {
  const Use client(*this);
  Client::NavStateHandler handler;
  if (wanted) handler = [&events = impl_->events](const NavState& state) { events.put(state); };
  client->on_nav_state(std::move(handler));
  if (!wanted) impl_->events.forget_states();
}

void Core::hear_alarms(bool wanted) {
  const Use client(*this);
  Client::AlarmHandler handler;
  if (wanted) handler = [&events = impl_->events](const Alarm& alarm) { events.put(alarm); };
  client->on_alarm(std::move(handler));
  if (!wanted) impl_->events.forget_alarms();
}

py::object Core::next_event() {
  Events::Event event;
  without_lock([&] { event = impl_->events.wait(); });
  if (const auto* state = std::get_if<NavState>(&event)) return py::make_tuple("nav_state", *state);
  if (const auto* alarm = std::get_if<Alarm>(&event)) return py::make_tuple("alarm", *alarm);
  return py::none();
}

void Core::close() {
  close(false);
}

void Core::close_at_exit() {
  close(true);
}

void Core::close(bool at_exit) {
  if (of_another_process()) return;
  without_lock([&] {
    impl_->events.end();
    std::unique_ptr<Client> client;
    std::unique_lock lock(impl_->mutex);
    impl_->closed = true;
    if (at_exit) impl_->exiting = std::this_thread::get_id();
    impl_->unused.wait(lock, [&] { return impl_->uses == 0; });
    client = std::move(impl_->client);
    lock.unlock();
    client.reset();
  });
}

namespace {

CommandKind kind_from(const std::string& word) {
  for (const CommandKind kind : {CommandKind::set_position, CommandKind::realign, CommandKind::enable_source,
                                 CommandKind::disable_source, CommandKind::acknowledge_alarm}) {
    if (to_string(kind) == word) return kind;
  }
  wrong_value("Client.order: kind", "an order that the client knows", text_of(word));
}

/// Of numbers that may be left out.
double maybe_from(py::handle value, const std::string& where) {
  return value.is_none() ? kUnknown : number_from(value, where);
}

void order(Core& core, const std::string& kind, py::handle target, py::handle latitude_rad,
           py::handle longitude_rad, py::handle depth_m, py::handle sigma_m, bool confirmed,
           py::handle timeout_s) {
  Command command;
  command.kind = kind_from(kind);
  const std::string where = "Client." + kind + ": ";
  if (!target.is_none()) command.target = Name(text_from(target, where + "name", Name::kCapacity));
  command.latitude_rad = maybe_from(latitude_rad, where + "latitude_rad");
  command.longitude_rad = maybe_from(longitude_rad, where + "longitude_rad");
  command.depth_m = maybe_from(depth_m, where + "depth_m");
  command.sigma_m = maybe_from(sigma_m, where + "sigma_m");
  command.confirmed = confirmed;
  core.order(command, number_from(timeout_s, where + "timeout_s"));
}

void tell_fix(Core& core, py::handle latitude_rad, py::handle longitude_rad, py::handle sigma_m,
              py::handle depth_m, py::handle stamp_ns, py::handle source, py::handle timeout_s) {
  const std::string where = "Client.tell_fix: ";
  FixSample fix;
  fix.latitude_rad = number_from(latitude_rad, where + "latitude_rad");
  fix.longitude_rad = number_from(longitude_rad, where + "longitude_rad");
  fix.sigma_m = number_from(sigma_m, where + "sigma_m");
  fix.depth_m = maybe_from(depth_m, where + "depth_m");
  if (!stamp_ns.is_none()) fix.header.stamp_ns = signed_from(stamp_ns, where + "stamp_ns");
  fix.header.sensor = Name(text_from(source, where + "source", Name::kCapacity));
  core.tell(fix, number_from(timeout_s, where + "timeout_s"));
}

}  // namespace

void add_core(py::module_& module) {
  py::class_<ScaledClock, std::shared_ptr<ScaledClock>>(
      module, "ScaledClock",
      "Runs `rate` times as fast as the host from `epoch_utc_ns` (ns since the Unix epoch, UTC) on, for "
      "accelerated\n"
      "simulations. All services of one are given the same epoch and rate.")
      .def(py::init([](py::handle epoch_utc_ns, py::handle rate) {
             const double times = number_from(rate, "ScaledClock.rate");
             if (!(times > 0.0 && times < 1e6)) wrong_value("ScaledClock.rate", "a number above 0", rate);
             return std::make_shared<ScaledClock>(signed_from(epoch_utc_ns, "ScaledClock.epoch_utc_ns"),
                                                  times);
           }),
           py::arg("epoch_utc_ns"), py::arg("rate"))
      .def("utc_ns", &ScaledClock::utc_ns, "Now, ns since the Unix epoch, UTC.")
      .attr("__module__") = "fathom";

  py::class_<Core>(module, "Core", "What fathom.Client is made of; not for use.")
      .def(py::init([](const ClientOptions& options, py::handle clock) {
        if (!clock.is_none() && !py::isinstance<ScaledClock>(clock)) {
          wrong_type("Client.clock", "a fathom.ScaledClock or None", clock);
        }
        return std::make_unique<Core>(options,
                                      clock.is_none() ? nullptr : clock.cast<std::shared_ptr<ScaledClock>>());
      }))
      .def("latest", [](const Core& core) { return or_none(core.latest()); })
      .def("age_s", &Core::age_s)
      .def("health", &Core::health)
      .def("alignment", [](const Core& core) { return or_none(core.alignment()); })
      .def("monitor", [](const Core& core) { return or_none(core.monitor()); })
      .def("publish_route",
           [](Core& core, py::handle route) {
             if (!py::isinstance<Route>(route))
               wrong_type("Client.publish_route: route", "a fathom.Route", route);
             core.publish_route(route.cast<const Route&>());
           })
      .def("wait_next",
           [](Core& core, py::handle timeout_s) {
             return or_none(core.wait_next(number_from(timeout_s, "Client.wait_next: timeout_s")));
           })
      .def("order", &order)
      .def("tell_fix", &tell_fix)
      .def("hear_states", &Core::hear_states)
      .def("hear_alarms", &Core::hear_alarms)
      .def("next_event", &Core::next_event)
      .def("close", py::overload_cast<>(&Core::close))
      .def("close_at_exit", &Core::close_at_exit);
}

}  // namespace fathom::python
