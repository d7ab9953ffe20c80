#include "security/pki.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

namespace fathom::security {
namespace {

constexpr const char* kOrganisation = "fathom";
constexpr int kSerialBits = 127;

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* what) const {
    Free(what);
  }
};
using BioPtr = std::unique_ptr<BIO, Freed<BIO_free_all>>;
using StorePtr = std::unique_ptr<X509_STORE, Freed<X509_STORE_free>>;
using ContextPtr = std::unique_ptr<X509_STORE_CTX, Freed<X509_STORE_CTX_free>>;
using Pkcs7Ptr = std::unique_ptr<PKCS7, Freed<PKCS7_free>>;
using NumberPtr = std::unique_ptr<BIGNUM, Freed<BN_free>>;
using TimePtr = std::unique_ptr<ASN1_TIME, Freed<ASN1_TIME_free>>;
using ExtensionPtr = std::unique_ptr<X509_EXTENSION, Freed<X509_EXTENSION_free>>;

/// The library's latest error in words, and none left for the next one to be confused with.
std::string reason() {
  const unsigned long code = ERR_peek_last_error();
  ERR_clear_error();
  if (code == 0) return "no reason given";
  const char* text = ERR_reason_error_string(code);
  return text != nullptr ? text : "error " + std::to_string(code);
}

template <class T>
T* must(T* result, const char* what) {
  if (result == nullptr) throw SecurityError(std::string(what) + " failed: " + reason());
  return result;
}
void must(int result, const char* what) {
  if (result <= 0) throw SecurityError(std::string(what) + " failed: " + reason());
}

BioPtr reading(const std::string& text) {
  return BioPtr(must(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), "reading from memory"));
}
BioPtr writing() {
  return BioPtr(must(BIO_new(BIO_s_mem()), "writing to memory"));
}
std::string text_of(const BioPtr& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

std::time_t to_time(TimeNs utc) {
  return static_cast<std::time_t>(utc / kNsPerSecond);
}

void add_entry(X509_NAME* name, const char* field, const std::string& text) {
  must(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8,
                                  reinterpret_cast<const unsigned char*>(text.c_str()), -1, -1, 0),
       "naming a certificate");
}

std::string entry(const X509_NAME* name, int field) {
  const int at = X509_NAME_get_index_by_NID(name, field, -1);
  if (at < 0) return {};
  const ASN1_STRING* text = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(name, at));
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<std::size_t>(ASN1_STRING_length(text))};
}

void add_extension(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const ExtensionPtr extension(
      must(X509V3_EXT_conf_nid(nullptr, &context, kind, value), "adding an extension"));
  must(X509_add_ext(certificate, extension.get(), -1), "adding an extension");
}

/// Everything of a certificate but its extensions and its signature.
Certificate unsigned_certificate(const Key& key, const Subject& subject, const Validity& validity) {
  Certificate result{std::shared_ptr<X509>(must(X509_new(), "making a certificate"), X509_free)};
  X509* x509 = result.handle.get();
  must(X509_set_version(x509, 2), "making a certificate");  // X.509 version 3
  const NumberPtr serial(must(BN_new(), "making a serial number"));
  must(BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY), "making a serial number");
  must(BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(x509)), "making a serial number");
  std::time_t from = to_time(validity.from_ns);
  std::time_t until = to_time(validity.until_ns);
  must(X509_time_adj(X509_getm_notBefore(x509), 0, &from), "dating a certificate");
  must(X509_time_adj(X509_getm_notAfter(x509), 0, &until), "dating a certificate");
  must(X509_set_pubkey(x509, key.handle.get()), "making a certificate");
  X509_NAME* name = X509_get_subject_name(x509);
  add_entry(name, "O", kOrganisation);
  add_entry(name, "OU", subject.vehicle);
  add_entry(name, "CN", subject.name);
  return result;
}

StorePtr trusting(const Certificate& authority, TimeNs now) {
  StorePtr store(must(X509_STORE_new(), "making a store of certificates"));
  must(X509_STORE_add_cert(store.get(), authority.handle.get()), "trusting a certificate");
  X509_VERIFY_PARAM_set_time(X509_STORE_get0_param(store.get()), to_time(now));
  return store;
}

}  // namespace

Key generate_key() {
  return {std::shared_ptr<EVP_PKEY>(must(EVP_EC_gen("P-256"), "making a key"), EVP_PKEY_free)};
}

Certificate make_authority(const Key& key, const Subject& subject, const Validity& validity) {
  Certificate result = unsigned_certificate(key, subject, validity);
  X509* x509 = result.handle.get();
  must(X509_set_issuer_name(x509, X509_get_subject_name(x509)), "making a certificate");
  add_extension(x509, x509, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  // It signs documents as well as certificates.
  add_extension(x509, x509, NID_key_usage, "critical,digitalSignature,keyCertSign,cRLSign");
  add_extension(x509, x509, NID_subject_key_identifier, "hash");
  must(X509_sign(x509, key.handle.get(), EVP_sha256()), "signing a certificate");
  return result;
}

Certificate issue(const Key& key, const Subject& subject, const Validity& validity, const Key& authority_key,
                  const Certificate& authority) {
  Certificate result = unsigned_certificate(key, subject, validity);
  X509* x509 = result.handle.get();
  must(X509_set_issuer_name(x509, X509_get_subject_name(authority.handle.get())), "making a certificate");
  add_extension(x509, authority.handle.get(), NID_basic_constraints, "critical,CA:FALSE");
  add_extension(x509, authority.handle.get(), NID_key_usage, "critical,digitalSignature");
  add_extension(x509, authority.handle.get(), NID_subject_key_identifier, "hash");
  add_extension(x509, authority.handle.get(), NID_authority_key_identifier, "keyid:always");
  must(X509_sign(x509, authority_key.handle.get(), EVP_sha256()), "signing a certificate");
  return result;
}

std::string to_pem(const Key& key) {
  const BioPtr out = writing();
  must(PEM_write_bio_PrivateKey(out.get(), key.handle.get(), nullptr, nullptr, 0, nullptr, nullptr),
       "writing a key");
  return text_of(out);
}

std::string to_pem(const Certificate& certificate) {
  const BioPtr out = writing();
  must(PEM_write_bio_X509(out.get(), certificate.handle.get()), "writing a certificate");
  return text_of(out);
}

Key key_from_pem(const std::string& pem, const std::string& place) {
  // No prompt for a passphrase: a service has nobody to ask.
  const auto refuse = [](char*, int, int, void*) { return 0; };
  EVP_PKEY* key = PEM_read_bio_PrivateKey(reading(pem).get(), nullptr, refuse, nullptr);
  if (key == nullptr) {
    throw SecurityError(place + ": holds no private key (" + reason() +
                        "), expected one in PEM without passphrase");
  }
  return {std::shared_ptr<EVP_PKEY>(key, EVP_PKEY_free)};
}

Certificate certificate_from_pem(const std::string& pem, const std::string& place) {
  X509* certificate = PEM_read_bio_X509(reading(pem).get(), nullptr, nullptr, nullptr);
  if (certificate == nullptr) {
    throw SecurityError(place + ": holds no certificate (" + reason() + "), expected one in PEM");
  }
  return {std::shared_ptr<X509>(certificate, X509_free)};
}

TimeNs instant_of(const ASN1_TIME* time) {
  const TimePtr epoch(must(ASN1_TIME_set(nullptr, 0), "reading a date"));
  int days = 0;
  int seconds = 0;
  must(ASN1_TIME_diff(&days, &seconds, epoch.get(), time), "reading a date");
  const std::int64_t since_epoch_s = static_cast<std::int64_t>(days) * 86400 + seconds;
  return std::min(since_epoch_s, std::numeric_limits<TimeNs>::max() / kNsPerSecond) * kNsPerSecond;
}

Validity validity_of(const Certificate& certificate) {
  return {instant_of(X509_get0_notBefore(certificate.handle.get())),
          instant_of(X509_get0_notAfter(certificate.handle.get()))};
}

Subject subject_of(const Certificate& certificate) {
  const X509_NAME* name = X509_get_subject_name(certificate.handle.get());
  return {entry(name, NID_organizationalUnitName), entry(name, NID_commonName)};
}

std::string subject_text(const Certificate& certificate) {
  const BioPtr out = writing();
  X509_NAME_print_ex(out.get(), X509_get_subject_name(certificate.handle.get()), 0,
                     XN_FLAG_RFC2253 & ~ASN1_STRFLGS_ESC_MSB);
  return text_of(out);
}

bool belong_together(const Key& key, const Certificate& certificate) {
  const bool match = X509_check_private_key(certificate.handle.get(), key.handle.get()) == 1;
  ERR_clear_error();
  return match;
}

std::string distrust(const Certificate& certificate, const Certificate& authority, TimeNs now) {
  const StorePtr store = trusting(authority, now);
  const ContextPtr context(must(X509_STORE_CTX_new(), "checking a certificate"));
  must(X509_STORE_CTX_init(context.get(), store.get(), certificate.handle.get(), nullptr),
       "checking a certificate");
  if (X509_verify_cert(context.get()) == 1) return {};
  ERR_clear_error();
  return X509_verify_cert_error_string(X509_STORE_CTX_get_error(context.get()));
}

std::string sign_document(const std::string& text, const Key& authority_key, const Certificate& authority) {
  constexpr int kFlags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
  const BioPtr in = reading(text);
  const Pkcs7Ptr signature(must(
      PKCS7_sign(authority.handle.get(), authority_key.handle.get(), nullptr, in.get(), kFlags), "signing"));
  const BioPtr out = writing();
  must(SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kFlags), "signing");
  return text_of(out);
}

std::string open_document(const std::string& document, const Certificate& authority, TimeNs now,
                          const std::string& place) {
  const BioPtr in = reading(document);
  BIO* parted = nullptr;
  const Pkcs7Ptr signature(SMIME_read_PKCS7(in.get(), &parted));
  const BioPtr content(parted);
  if (!signature) {
    throw SecurityError(place + ": is no signed document (" + reason() +
                        "), expected S/MIME as fathom keygen writes");
  }
  const StorePtr store = trusting(authority, now);
  const BioPtr out = writing();
  if (PKCS7_verify(signature.get(), nullptr, store.get(), content.get(), out.get(), PKCS7_TEXT) != 1) {
    throw SecurityError(place + ": the signature does not hold (" + reason() +
                        "), expected one of the permissions CA");
  }
  return text_of(out);
}

}  // namespace fathom::security
