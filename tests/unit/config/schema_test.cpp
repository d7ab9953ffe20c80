#include "config/json/schema.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/unknown.hpp"

namespace fathom::config {

enum class Kind { tcp, udp };
struct Inner {
  std::string host;
  int port = 80;
};
struct Outer {
  Name vehicle = "auv";
  bool on = true;
  double latitude_rad = 0.0;
  double sigma_m = kUnknown;
  Kind kind = Kind::tcp;
  std::vector<Inner> links;
  std::array<double, 3> lever_B_m{0.0, 0.0, 0.0};
  std::optional<double> limit_s;
  std::map<std::string, double> rates;
  std::uint16_t small = 1;
};

void describe(Schema<Inner>& s) {
  s.field("host", &Inner::host, "address").required();
  s.field("port", &Inner::port, "TCP port").range(1, 65535);
}
void describe(Schema<Outer>& s) {
  s.field("vehicle", &Outer::vehicle, "vehicle name");
  s.field("on", &Outer::on, "switched on");
  s.field("latitude_deg", &Outer::latitude_rad, "latitude")
      .unit("deg")
      .range(-90, 90)
      .scaled(0.01745329251994329577);
  s.field("sigma_m", &Outer::sigma_m, "noise").unit("m").range(0, 100).nullable();
  s.field("kind", &Outer::kind, "transport").words({{"tcp", Kind::tcp}, {"udp", Kind::udp}});
  s.field("links", &Outer::links, "links");
  s.field("lever_B_m", &Outer::lever_B_m, "lever arm").range(-50, 50).unit("m");
  s.field("limit_s", &Outer::limit_s, "limit").range(0, 10);
  s.field("rates", &Outer::rates, "rates by name").range(0, 1000);
  s.field("small", &Outer::small, "a small number");
  s.check([](const Outer& o) {
    return o.on || o.links.empty() ? std::pair<std::string, std::string>{}
                                   : std::pair<std::string, std::string>{"on", "true where there are links"};
  });
}

/// A shape: which of its sizes mean something follows from what it is.
struct Solid {
  Kind transport = Kind::tcp;
  std::string shape = "ball";
  double radius_m = 1.0;
  double edge_m = 2.0;
};
void describe(Schema<Solid>& s) {
  s.field("shape", &Solid::shape, "its form")
      .decides({"ball", "box"}, [](const std::string& text) -> std::string {
        return text == "ball" || text == "sphere" ? "ball" : text == "box" ? "box" : "";
      });
  s.field("radius_m", &Solid::radius_m, "of the ball").unit("m").only_for({"ball"}).required_for({"ball"});
  s.field("edge_m", &Solid::edge_m, "its edge").unit("m").range(0, 10).only_for({"box"});
  s.defaults_by_choice([](const std::string& shape) {
    Solid out;
    out.edge_m = shape == "box" ? 3.0 : 2.0;
    return out;
  });
  s.check_values([](const Solid& solid) -> std::optional<Complaint> {
    if (solid.edge_m < 9.0) return std::nullopt;
    return Complaint{"edge_m", "too long", "less than 9"};
  });
}

namespace {

class SchemaTest : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::string path = ::testing::TempDir() + "schema_" +
                       ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
    std::ofstream(path) << text;
    return path;
  }
  std::string error_of(const std::string& text, std::vector<std::string> sets = {}) {
    try {
      (void)load<Outer>({write(text), std::move(sets)});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(SchemaTest, LoadsEveryKindOfValue) {
  const auto file =
      write(R"({"$schema":"x.json","vehicle":"a","on":false,"latitude_deg":45,"sigma_m":null,"kind":"udp",
      "lever_B_m":[1,2,3],"limit_s":2.5,"rates":{"imu":100},"small":65535})");
  const auto out = load<Outer>({file, {}});
  EXPECT_EQ(out.vehicle, Name("a"));
  EXPECT_FALSE(out.on);
  EXPECT_DOUBLE_EQ(out.latitude_rad, 45 * 0.01745329251994329577);
  EXPECT_FALSE(known(out.sigma_m));
  EXPECT_EQ(out.kind, Kind::udp);
  EXPECT_EQ(out.lever_B_m[2], 3.0);
  EXPECT_EQ(out.limit_s, 2.5);
  EXPECT_EQ(out.rates.at("imu"), 100.0);
  EXPECT_EQ(out.small, 65535);
}

TEST_F(SchemaTest, TakesACommentAnywhereAndNothingElseThatItDoesNotKnow) {
  const auto commented = write(R"({"$comment":"from the data sheet","vehicle":"a"})");
  const auto plain = write(R"({"vehicle":"a"})");
  EXPECT_EQ(canonical(load<Outer>({commented, {}})), canonical(load<Outer>({plain, {}})));
  EXPECT_NE(error_of(R"({"$comment":5,"vehicle":"a"})").find("expected a text"), std::string::npos);
  EXPECT_NE(error_of(R"({"$remark":"x","vehicle":"a"})").find("no such key"), std::string::npos);
}

TEST_F(SchemaTest, NamesFileKeyValueAndExpectation) {
  struct Case {
    std::string json, expected;
  };
  const Case cases[] = {
      {R"({"vehicel":"a"})",
       "vehicel: is \"a\", expected no such key; the nearest is vehicle; known keys: vehicle"},
      {R"({"on":1})", "on: is 1, expected true or false"},
      {R"({"latitude_deg":91})", "latitude_deg: is 91, expected a number from -90 to 90"},
      {R"({"latitude_deg":"x"})", "latitude_deg: is \"x\", expected a number from -90 to 90"},
      {R"({"latitude_deg":null})", "latitude_deg: is null, expected a number"},
      {R"({"kind":"serial"})", "kind: is \"serial\", expected one of tcp, udp"},
      {R"({"links":[{"port":1}]})", "links.0.host: is missing, expected address"},
      {R"({"links":[{"host":"h","port":0}]})", "links.0.port: is 0, expected a whole number from 1 to 65535"},
      {R"({"links":{}})", "links: is {}, expected an array"},
      {R"({"lever_B_m":[1,2]})", "lever_B_m: is [1,2], expected an array of 3"},
      {R"({"small":65536})", "small: is 65536, expected a whole number from 0 to 65535"},
      {R"({"small":1.5})", "small: is 1.5, expected a whole number from 0 to 65535"},
      {R"({"vehicle":"0123456789012345678901234567890123456789"})", "expected nothing or 1 to 31 letters"},
      {R"({"vehicle":"a/b"})", "vehicle: is \"a/b\", expected nothing or 1 to 31 letters, digits"},
      {R"({"links":[{"host":"a\nb"}]})", "links.0.host: is \"a\\nb\", expected a text without control"},
      {R"({"on":false,"links":[{"host":"h"}]})", "on: is false, expected true where there are links"},
      {R"([])", "(whole file): is [], expected an object"},
      {"{\n\"on\": tru\n}", ":2: is not JSON: syntax error"},
  };
  for (const auto& c : cases) EXPECT_THAT(error_of(c.json), ::testing::HasSubstr(c.expected)) << c.json;
}

TEST_F(SchemaTest, OverridesReachNestedKeysAndAreCheckedLikeTheFile) {
  const auto file = write(R"({"links":[{"host":"h"}]})");
  const auto out = load<Outer>({file, {"links.0.port=99", "links.0.host=/dev/ttyS0", "rates.imu=5"}});
  EXPECT_EQ(out.links.at(0).port, 99);
  EXPECT_EQ(out.links.at(0).host, "/dev/ttyS0");
  EXPECT_EQ(out.rates.at("imu"), 5.0);
  EXPECT_THAT(error_of("{}", {"links.0.port=1"}), ::testing::HasSubstr("links"));
  EXPECT_THAT(error_of("{}", {"onn=true"}), ::testing::HasSubstr("no such key"));
  EXPECT_THAT(error_of("{}", {"nonsense"}), ::testing::HasSubstr("expected key.sub=value"));
}

TEST_F(SchemaTest, MissingFileIsNamed) {
  try {
    (void)load<Outer>({"/nowhere/x.json", {}});
    FAIL() << "loaded a file that does not exist";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr("/nowhere/x.json: cannot be read: No such file or directory, expected"));
  }
}

TEST_F(SchemaTest, DumpLoadsBackToTheSameDump) {
  Outer value;
  value.latitude_rad = 0.5;
  value.links = {{"a", 1}, {"b", 2}};
  const std::string once = canonical(value);
  const auto again = load<Outer>({write(once), {}});
  EXPECT_EQ(canonical(again), once);
}

TEST_F(SchemaTest, JsonSchemaCarriesRangesWordsAndDefaults) {
  const auto schema = nlohmann::json::parse(schema_text<Outer>("outer"));
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["properties"]["latitude_deg"]["maximum"], 90.0);
  EXPECT_EQ(schema["properties"]["kind"]["enum"], nlohmann::json::array({"tcp", "udp"}));
  EXPECT_EQ(schema["properties"]["links"]["items"]["required"][0], "host");
  EXPECT_EQ(schema["properties"]["vehicle"]["default"], "auv");
}

std::string solid_error(const std::string& text) {
  Solid out;
  try {
    schema_of<Solid>().load(nlohmann::json::parse(text), out, {"solid.json", ""});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(SchemaTest, RefusesAKeyThatMeansNothingForTheChoiceMade) {
  EXPECT_EQ(
      solid_error(R"({"shape": "box", "radius_m": 1})"),
      "solid.json: radius_m: is 1, expected no such key where shape is box; it is known where shape is one "
      "of ball");
  EXPECT_EQ(
      solid_error(R"({"shape": "sphere", "radius_m": 1, "edge_m": 1})"),
      "solid.json: edge_m: is 1, expected no such key where shape is ball; it is known where shape is one "
      "of box");
  EXPECT_EQ(solid_error(R"({"edge_m": 1})"), solid_error(R"({"shape": "ball", "edge_m": 1})"));
  EXPECT_EQ(solid_error(R"({"shape": "sphere"})"), "solid.json: radius_m: is missing, expected of the ball");
  EXPECT_EQ(solid_error(R"({"shape": "sphere", "radius_m": 1})"), "no error");
}

TEST_F(SchemaTest, AChoiceHasDefaultsOfItsOwn) {
  Solid out;
  schema_of<Solid>().load(nlohmann::json::parse(R"({"shape": "box"})"), out, {"solid.json", ""});
  EXPECT_EQ(out.edge_m, 3.0);
  EXPECT_EQ(out.shape, "box");
}

TEST_F(SchemaTest, JsonSchemaForbidsWhatTheLoaderForbids) {
  const auto schema = nlohmann::json::parse(schema_text<Solid>("solid"));
  ASSERT_EQ(schema["allOf"].size(), 2U);
  EXPECT_EQ(schema["allOf"][0]["if"]["properties"]["shape"]["const"], "ball");
  EXPECT_EQ(schema["allOf"][0]["then"]["properties"]["edge_m"], false);
  EXPECT_EQ(schema["allOf"][0]["then"]["required"][0], "radius_m");
  EXPECT_EQ(schema["allOf"][1]["then"]["properties"]["radius_m"], false);
  EXPECT_EQ(schema["allOf"][1]["then"]["properties"]["edge_m"]["default"], 3.0);
}

TEST_F(SchemaTest, AComplaintSaysWhatStandsInTheFile) {
  EXPECT_EQ(solid_error(R"({"shape": "box", "edge_m": 9.5})"),
            "solid.json: edge_m: is 9.5, expected less than 9");
}

}  // namespace
}  // namespace fathom::config
