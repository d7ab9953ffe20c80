#include "bridge/frame_text.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "codec/registry.hpp"

namespace fathom::bridge {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

TEST(FrameText, ShowsTextAsTextAndOtherBytesInHexadecimal) {
  EXPECT_EQ(shown(bytes_of("$SDDBT,1,f\r\n")), "\"$SDDBT,1,f\"");
  EXPECT_EQ(shown(std::vector<std::uint8_t>{0xB5, 0x62, 0x01}), "b5 62 01");
  EXPECT_EQ(shown(bytes_of("\x1b[31m")), "1b 5b 33 31 6d") << "nothing that a terminal obeys";
  EXPECT_EQ(shown(bytes_of(std::string(1000, 'x'))), "\"" + std::string(120, 'x') + "\" ...");
  EXPECT_EQ(shown({}), "");
}

TEST(FrameText, ARefusedFrameIsShownWithWhatIsWrong) {
  struct Sink : codec::Sink {
    void on_sample(const codec::Decoded&) override {}
    void on_rejected(const codec::Rejected& rejected) override { said.push_back(sentence(rejected)); }
    std::vector<std::string> said;
  } sink;
  codec::CodecOptions options;
  options.require_checksum = false;
  const auto codec = codec::find_protocol("nmea0183")->make(options);
  codec->feed(bytes_of("$SDDBT,,f,x,M,,F\r\n"), sink);
  codec->feed(bytes_of("$SDDBT,,f,5.0,M,,F*00\r\n$SDDBT,,f,5"), sink);
  codec->finish(sink);
  EXPECT_EQ(sink.said,
            (std::vector<std::string>{
                "frame of 16 bytes refused (field: a field is not a number, or none of its words): "
                "\"$SDDBT,,f,x,M,,F\"",
                "frame of 21 bytes refused (checksum: its checksum is wrong): "
                "\"$SDDBT,,f,5.0,M,,F*00\"",
                "frame of 11 bytes refused (truncated: the stream ended inside it): \"$SDDBT,,f,5\""}));
}

}  // namespace
}  // namespace fathom::bridge
