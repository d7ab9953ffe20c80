#include "host/supervisor.hpp"

#include <string>

#include <systemd/sd-daemon.h>

namespace fathom::host::supervisor {

void ready() {
  sd_notify(0, "READY=1");
}

void alive(std::string_view text) {
  std::string message = "WATCHDOG=1\nSTATUS=";
  for (const char c : text) message += c == '\n' ? ' ' : c;
  sd_notify(0, message.c_str());
}

void stopping() {
  sd_notify(0, "STOPPING=1");
}

}  // namespace fathom::host::supervisor
