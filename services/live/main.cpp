#include "cli/program.hpp"
#include "live/command.hpp"

int main(int argc, char** argv) {
  return fathom::cli::run_program(argc, argv, fathom::cli::live_commands());
}
