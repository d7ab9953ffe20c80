#include "host/supervisor.hpp"

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>

#include <sys/socket.h>
#include <sys/un.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace fathom::host::supervisor {
namespace {

/// As sd_notify() does, but it never waits: who is to hear it may stand still, and the next one comes in a
/// second.
void say(const std::string& message) {
  const char* place = std::getenv("NOTIFY_SOCKET");
  sockaddr_un there{};
  there.sun_family = AF_UNIX;
  const std::size_t size = place == nullptr ? 0 : std::strlen(place);
  if (size < 2 || size >= sizeof there.sun_path) return;
  if (*place != '/' && *place != '@') {  // of a virtual machine's host
    sd_notify(0, message.c_str());
    return;
  }
  std::memcpy(there.sun_path, place, size);
  if (*place == '@') there.sun_path[0] = '\0';
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return;
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + size);
  (void)!::sendto(socket, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&there), length);
  ::close(socket);
}

}  // namespace

void ready() {
  sd_notify(0, "READY=1");
}

void alive(std::string_view text) {
  std::string message = "WATCHDOG=1\nSTATUS=";
  for (const char c : text) message += c == '\n' ? ' ' : c;
  say(message);
}

void stopping() {
  sd_notify(0, "STOPPING=1");
}

}  // namespace fathom::host::supervisor
