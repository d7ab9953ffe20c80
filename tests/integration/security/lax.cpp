// An attacker does not run our software. In a process with TEST_LAX in its environment the checks that Fast
// DDS and OpenSSL make on the attacker's own side answer "yes": of certificates, and of what its permissions
// allow. Everywhere else they answer as always.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <openssl/x509.h>
#include <sys/mman.h>
#include <unistd.h>

namespace {

bool lax() {
  return std::getenv("TEST_LAX") != nullptr;
}

bool yes(void* /*permissions*/, const void*, std::uint32_t, const void*, const void*, void*) {
  return true;
}

/// Puts yes() in the place of the virtual functions that say what may be published and read. The class is not
/// among the library's public headers, so its names are those of the linker. Its name space is fastrtps until
/// Fast DDS 3, which has it in fastdds. A function of the same name in this program would not be enough:
/// where the library is linked with -Bsymbolic-functions, as Ubuntu does it, the library takes its own.
void allow_everything() {
  for (const std::string name_space : {"8fastrtps", "7fastdds"}) {
    const std::string permissions = "N8eprosima" + name_space + "4rtps8security11Permissions";
    void* const table = dlsym(RTLD_DEFAULT, ("_ZTV" + permissions + "E").c_str());
    if (table == nullptr) continue;
    Dl_info of{};
    void* found = nullptr;
    if (dladdr1(table, &of, &found, RTLD_DL_SYMENT) == 0 || found == nullptr) break;
    const auto* symbol = static_cast<const ElfW(Sym)*>(found);
    const std::span entries(static_cast<void**>(table), symbol->st_size / sizeof(void*));
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const std::uintptr_t first = reinterpret_cast<std::uintptr_t>(table) / page * page;
    const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(entries.data() + entries.size());
    if (mprotect(reinterpret_cast<void*>(first), end - first, PROT_READ | PROT_WRITE) != 0) break;
    int replaced = 0;
    for (const char* function : {"23check_create_datawriter", "23check_create_datareader"}) {
      const std::string name =
          "_Z" + permissions + function +
          "ERKNS2_6HandleEjRKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKSt6vector"
          "ISC_SaISC_EERNS2_17SecurityExceptionE";
      const auto entry = std::ranges::find(entries, dlsym(RTLD_DEFAULT, name.c_str()));
      if (entry == entries.end()) continue;
      *entry = reinterpret_cast<void*>(&yes);
      ++replaced;
    }
    if (replaced == 2) return;
  }
  std::fputs("TEST_LAX: what Fast DDS asks of its permissions was not found\n", stderr);
  std::abort();
}

[[gnu::constructor]] void begin() {
  if (lax()) allow_everything();
}

}  // namespace

// It comes before the library's own when the program is loaded.
extern "C" int X509_verify_cert(X509_STORE_CTX* context) {
  if (lax()) return 1;
  static const auto real = reinterpret_cast<int (*)(X509_STORE_CTX*)>(dlsym(RTLD_NEXT, "X509_verify_cert"));
  return real(context);
}
