#include "mavlink/signing.hpp"

#include <algorithm>
#include <charconv>
#include <memory>

#include <openssl/crypto.h>
#include <openssl/evp.h>

namespace fathom::mavlink {
namespace {

constexpr TimeNs kEpoch_ns = 1'420'070'400 * kNsPerSecond;  // 2015-01-01
constexpr DurationNs kUnit_ns = 10'000;
constexpr std::uint64_t kMinute = 6'000'000;
constexpr std::size_t kTimeBytes = 6;
constexpr std::size_t kDigest = 6;

/// The first 48 bits of SHA-256 over key and signed bytes.
std::array<std::uint8_t, kDigest> digest_of(const Key& key, Bytes bytes) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> whole{};
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  EVP_DigestUpdate(context.get(), key.data(), key.size());
  EVP_DigestUpdate(context.get(), bytes.data(), bytes.size());
  EVP_DigestFinal_ex(context.get(), whole.data(), nullptr);
  std::array<std::uint8_t, kDigest> out{};
  std::copy_n(whole.begin(), out.size(), out.begin());
  return out;
}

}  // namespace

Result<Key> key_of(const std::string& text) {
  std::string digits = text;
  std::erase_if(digits, [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; });
  Key key{};
  if (digits.size() != 2 * key.size())
    return Error{"has " + std::to_string(digits.size()) + " characters, expected 64 hexadecimal digits"};
  for (std::size_t i = 0; i < key.size(); ++i) {
    const char* first = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(first, first + 2, key[i], 16);
    if (error != std::errc() || end != first + 2)
      return Error{"has something else than hexadecimal digits, expected 64 of them"};
  }
  return key;
}

std::uint64_t signing_time(TimeNs utc_ns) {
  return utc_ns <= kEpoch_ns ? 0 : static_cast<std::uint64_t>((utc_ns - kEpoch_ns) / kUnit_ns);
}

void Signer::sign(std::vector<std::uint8_t>& frame, TimeNs utc_ns) {
  last_ = std::max(last_ + 1, signing_time(utc_ns));
  frame.push_back(link_);
  for (std::size_t i = 0; i < kTimeBytes; ++i) frame.push_back(static_cast<std::uint8_t>(last_ >> (8U * i)));
  const auto digest = digest_of(key_, frame);
  frame.insert(frame.end(), digest.begin(), digest.end());
}

std::string_view to_string(Trust trust) {
  switch (trust) {
    case Trust::trusted:
      return "trusted";
    case Trust::not_signed:
      return "not signed";
    case Trust::wrong_signature:
      return "signed with another key";
    case Trust::said_before:
      return "said before";
    case Trust::too_old:
      break;
  }
  return "signed more than a minute ago";
}

Trust Verifier::judge(const Frame& frame, TimeNs utc_ns) {
  if (!frame.is_signed) return Trust::not_signed;
  const std::size_t before = frame.whole.size() - kDigest;
  const auto digest = digest_of(key_, frame.whole.first(before));
  if (CRYPTO_memcmp(digest.data(), frame.whole.data() + before, kDigest) != 0) return Trust::wrong_signature;
  std::uint64_t time = 0;
  for (std::size_t i = 0; i < kTimeBytes; ++i)
    time |= static_cast<std::uint64_t>(frame.whole[before - kTimeBytes + i]) << (8U * i);
  const std::array<std::uint8_t, 3> sender{frame.system, frame.component,
                                           frame.whole[before - kTimeBytes - 1]};
  const auto known = last_.find(sender);
  if (known != last_.end() && time <= known->second) return Trust::said_before;
  if (known == last_.end()) {
    if (time + kMinute < signing_time(utc_ns) || last_.size() >= kMostSenders) return Trust::too_old;
  }
  last_[sender] = time;
  return Trust::trusted;
}

}  // namespace fathom::mavlink
