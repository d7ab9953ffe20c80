#include "cli/command.hpp"
#include "cli/program.hpp"

int main(int argc, char** argv) {
  return fathom::cli::run_program(argc, argv, fathom::cli::commands(argv));
}
