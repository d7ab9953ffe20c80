#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

namespace fathom::test {

/// Two machines on a wire that can be cut, as network namespaces. Needs root and iproute2.
class CutWire {
 public:
  CutWire() {
    if (geteuid() != 0) {
      trouble_ = "network namespaces need root";
      return;
    }
    own_ = open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
    if (own_ < 0 || !run("ip netns add " + name("wire"))) {
      trouble_ = "network namespaces are not permitted, or iproute2 is not there";
      return;
    }
    bool made = run("ip -n " + name("wire") + " link add wire type bridge") &&
                run("ip -n " + name("wire") + " link set wire up");
    for (const int number : {1, 2}) {
      const std::string machine = name(std::to_string(number));
      made = made && run("ip netns add " + machine) &&
             run("ip -n " + machine + " link add eth0 type veth peer name " + plug(number) + " netns " +
                 name("wire")) &&
             run("ip -n " + name("wire") + " link set " + plug(number) + " master wire up") &&
             run("ip -n " + machine + " address add " + address(number) + "/24 dev eth0") &&
             run("ip -n " + machine + " link set eth0 up") && run("ip -n " + machine + " link set lo up");
    }
    if (!made || !isolate(2, "on")) trouble_ = "the network namespaces cannot be joined";
  }
  ~CutWire() {
    for (const char* one : {"1", "2", "wire"}) (void)run("ip netns delete " + name(one));
    if (own_ >= 0) close(own_);
  }
  CutWire(const CutWire&) = delete;
  CutWire& operator=(const CutWire&) = delete;

  /// Why there is no such wire; empty: there is.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] static std::string address(int number) { return "10.78.0." + std::to_string(number); }

  /// Calls `make` with this thread on machine `number` (1 or 2): sockets opened in it, and threads begun, are
  /// of that machine.
  template <class Make>
  auto on(int number, const Make& make) const {
    const std::string path = "/run/netns/" + name(std::to_string(number));
    const int there = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (there < 0 || setns(there, CLONE_NEWNET) != 0) throw std::runtime_error(path + ": cannot be entered");
    close(there);
    auto made = make();
    if (setns(own_, CLONE_NEWNET) != 0) throw std::runtime_error("the way back is lost");
    return made;
  }
  /// Neither machine notices but by what does not arrive. A plug is isolated, not pulled: the kernel waits
  /// for all processors when it takes one out, on a busy machine for seconds.
  void cut() const {
    if (!isolate(1, "on")) throw std::runtime_error("the wire cannot be cut");
  }
  void mend() const {
    if (!isolate(1, "off")) throw std::runtime_error("the wire cannot be mended");
  }

 private:
  static std::string name(const std::string& what) { return "fac" + std::to_string(getpid()) + what; }
  static std::string plug(int number) { return "to" + std::to_string(number); }
  /// The bridge passes nothing between two plugs that are isolated.
  static bool isolate(int number, const std::string& whether) {
    return run("ip -n " + name("wire") + " link set " + plug(number) + " type bridge_slave isolated " +
               whether);
  }
  static bool run(const std::string& command) {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;  // NOLINT(concurrency-mt-unsafe)
  }

  int own_ = -1;
  std::string trouble_;
};

}  // namespace fathom::test
