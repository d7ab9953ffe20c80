// An attacker does not run our software. In a process with TEST_LAX in its environment the checks that Fast
// DDS and OpenSSL make on the attacker's own side answer "yes": of certificates, and of what its permissions
// allow. Everywhere else they answer as always. The functions below come before the libraries' own when the
// program is loaded.

#include <cstdint>
#include <cstdlib>

#include <dlfcn.h>
#include <openssl/x509.h>

namespace {

bool lax() {
  return std::getenv("TEST_LAX") != nullptr;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

// Mangled: the class is not among the library's public headers. Its name space is fastrtps until Fast DDS 3,
// which has it in fastdds.
#define PERMISSIONS(name_space, function)                                                                  \
  "_ZN8eprosima" name_space "4rtps8security11Permissions23" function                                       \
  "ERKNS2_6HandleEjRKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKSt6vectorISC_SaISC_EERNS2_17Se" \
  "curityExceptionE"

using Check = bool (*)(void*, const void*, std::uint32_t, const void*, const void*, void*);

}  // namespace

extern "C" {

int X509_verify_cert(X509_STORE_CTX* context) {
  if (lax()) return 1;
  static const auto real = next<int (*)(X509_STORE_CTX*)>("X509_verify_cert");
  return real(context);
}

#define ANSWERS_YES(function, symbol)                                                         \
  bool function(void* self, const void* permissions, std::uint32_t domain, const void* topic, \
                const void* partitions, void* exception) __asm__(symbol);                     \
  bool function(void* self, const void* permissions, std::uint32_t domain, const void* topic, \
                const void* partitions, void* exception) {                                    \
    if (lax()) return true;                                                                   \
    static const auto real = next<Check>(symbol);                                             \
    return real(self, permissions, domain, topic, partitions, exception);                     \
  }

ANSWERS_YES(lax_writer, PERMISSIONS("8fastrtps", "check_create_datawriter"))
ANSWERS_YES(lax_reader, PERMISSIONS("8fastrtps", "check_create_datareader"))
ANSWERS_YES(lax_writer_3, PERMISSIONS("7fastdds", "check_create_datawriter"))
ANSWERS_YES(lax_reader_3, PERMISSIONS("7fastdds", "check_create_datareader"))

}  // extern "C"
