// A reader that forgot what it had says so, and is taken at its word.

#include "bus/detail/network/acknowledgements.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/detail/network/transport.hpp"
#include "bus/detail/security/datagram_check.hpp"
#include "support/rtps_datagram.hpp"
#include "unit/bus/bodies.hpp"

namespace fathom::bus::detail {
namespace {

using test::rtps::Bytes;
using test::rtps::datagram;
using test::rtps::kHeartbeat;
using test::rtps::put_u16;
using test::rtps::submessage;
using testing::ElementsAre;

constexpr EntityId kWriter = 0x0000'04C2;
constexpr std::uint8_t kFinal = 2;

WriterGuid reader(std::uint8_t participant = 0x11, std::uint8_t number = 4) {
  WriterGuid guid{};
  std::fill_n(guid.begin(), 12, participant);
  guid[14] = number;
  guid[15] = 0xC7;
  return guid;
}

class Acknowledgements : public testing::Test {
 protected:
  Acknowledgements() { book.seen(prefix_of(reader())); }
  bool goes_back(std::uint64_t base, std::uint32_t count, const WriterGuid& who = reader(),
                 EntityId writer = kWriter) {
    return book.goes_back({who, writer, base, count});
  }
  AcknowledgementBook book;
};

TEST_F(Acknowledgements, GoUpAndMayStandStill) {
  EXPECT_FALSE(goes_back(0, 1));
  EXPECT_FALSE(goes_back(1, 2));
  EXPECT_FALSE(goes_back(19, 3));
  EXPECT_FALSE(goes_back(19, 4));
}

TEST_F(Acknowledgements, OfAReaderThatForgotGoBackOnce) {
  EXPECT_FALSE(goes_back(19, 7));
  EXPECT_TRUE(goes_back(1, 9));
  EXPECT_FALSE(goes_back(1, 10));  // it asks again, until it has them
  EXPECT_FALSE(goes_back(14, 11));
  EXPECT_TRUE(goes_back(3, 12));
}

TEST_F(Acknowledgements, OfAReaderThatSaysItselfThatItBeginsDoNotGoBack) {
  EXPECT_FALSE(goes_back(19, 7));
  EXPECT_FALSE(goes_back(0, 8));
  EXPECT_FALSE(goes_back(1, 9));
}

TEST_F(Acknowledgements, ThatComeLateAreNothing) {
  EXPECT_FALSE(goes_back(19, 7));
  EXPECT_FALSE(goes_back(4, 6));
  EXPECT_FALSE(goes_back(4, 7));
  EXPECT_FALSE(goes_back(19, 8));
}

TEST_F(Acknowledgements, AreOfOneReaderAndOneWriter) {
  EXPECT_FALSE(goes_back(19, 7));
  EXPECT_FALSE(goes_back(1, 8, reader(), kWriter + 0x100));
  EXPECT_FALSE(goes_back(1, 8, reader(0x11, 5)));
  book.seen(prefix_of(reader(0x22)));
  EXPECT_FALSE(goes_back(1, 8, reader(0x22)));
}

TEST_F(Acknowledgements, OfThoseWhoLeftAreForgotten) {
  EXPECT_FALSE(goes_back(19, 7));
  book.seen(prefix_of(reader()));  // announced again, not come again
  EXPECT_TRUE(goes_back(18, 8));
  book.gone(prefix_of(reader()));
  EXPECT_FALSE(goes_back(1, 9));
  book.seen(prefix_of(reader()));
  EXPECT_FALSE(goes_back(1, 10));
}

/// Of reader kReader, which lacks `words` * 32 samples; as Fast DDS sends it, to kWriter.
Bytes acknack(std::uint8_t base, std::uint8_t count, std::uint16_t words, bool little, bool final = false) {
  Bytes out = submessage(0x06, static_cast<std::uint16_t>(24 + 4 * words), little);
  if (final) out[1] |= kFinal;
  std::fill(out.begin() + 4, out.begin() + 24, 0);
  out[6] = out[10] = 4;
  out[7] = 0xC7;
  out[11] = 0xC2;
  out[little ? 16U : 19U] = base;
  put_u16(out, little ? 20 : 22, 32U * words, little);
  std::fill(out.end() - 4, out.end(), 0);
  *(out.end() - (little ? 4 : 1)) = count;
  return out;
}

std::vector<std::vector<std::uint64_t>> told(const Bytes& bytes) {
  std::vector<std::vector<std::uint64_t>> out;
  all_acknowledgements(bytes, [&](const Acknowledgement& one) {
    EXPECT_EQ(one.reader, reader());
    out.push_back({one.writer, one.base, one.count, one.at});
  });
  return out;
}

TEST(Acknacks, AreReadWhateverTheOrderOfTheirBytes) {
  const Bytes bytes =
      datagram({submessage(kHeartbeat, 28), acknack(19, 7, 0, true), acknack(3, 8, 2, false)});
  EXPECT_THAT(told(bytes), ElementsAre(ElementsAre(kWriter, 19, 7, 56), ElementsAre(kWriter, 3, 8, 84)));
}

TEST(Acknacks, ThatDoNotHoldTogetherAreNotRead) {
  const Bytes whole = acknack(19, 7, 2, true);
  for (std::uint16_t size = 0; size < 32; ++size) {
    Bytes cut(whole.begin(), whole.begin() + 4 + size);
    put_u16(cut, 2, size);
    EXPECT_THAT(told(datagram({cut, submessage(kHeartbeat, 28)})), ElementsAre()) << size;
  }
  Bytes endless = whole;
  std::fill_n(endless.begin() + 20, 4, 0xFF);
  EXPECT_THAT(told(datagram({endless})), ElementsAre());
  EXPECT_THAT(told({}), ElementsAre());
}

TEST(Acknacks, ThatGoBackAreHandedOnAsTheFirstOfAReader) {
  const auto book = std::make_shared<AcknowledgementBook>();
  book->seen(prefix_of(reader()));
  const std::unique_ptr<fastdds::ChainingTransport> transport(dynamic_cast<fastdds::ChainingTransport*>(
      TransportDescriptor(std::make_shared<fastdds::UDPv4TransportDescriptor>(),
                          std::make_shared<LowPriorityPeers>(), std::make_shared<DeliveryWatch>(), book,
                          [](const std::string&) {})
          .create_transport()));
  Dds dds;
  for (const bool little : {true, false}) {
    const std::uint8_t before = little ? 0 : 20;
    const auto count = [&](int more) { return static_cast<std::uint8_t>(before + more); };
    const Bytes first = datagram({acknack(19, count(1), 0, little, true)});
    const Bytes back = datagram({submessage(kHeartbeat, 28), acknack(1, count(2), 1, little, true)});
    const Bytes again = datagram({acknack(1, count(3), 1, little)});
    dds.received.clear();
    for (const Bytes* one : {&first, &back, &again}) {
      transport->receive(&dds, one->data(), static_cast<std::uint32_t>(one->size()), {}, {});
    }
    ASSERT_EQ(dds.received.size(), 3U);
    EXPECT_EQ(dds.received[0], first);
    EXPECT_EQ(dds.received[2], again);
    // As sent by one that has just met the writer, but for what stands behind its end.
    Bytes expected = back;
    const Bytes begins = acknack(0, count(2), 0, little);
    std::copy(begins.begin() + 4, begins.end(), expected.begin() + 56);
    expected[53] = begins[1];
    EXPECT_EQ(dds.received[1], expected);
    EXPECT_THAT(told(dds.received[1]), ElementsAre(ElementsAre(kWriter, 0, count(2), 56)));
  }
}

}  // namespace
}  // namespace fathom::bus::detail
