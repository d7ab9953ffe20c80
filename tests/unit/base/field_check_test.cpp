#include "base/field_check.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace fathom {

enum class Shape : std::uint8_t { ball, box };
struct Part {
  std::array<double, 2> angle_rad{0.0, 0.0};
};
struct Thing {
  std::string name = "thing";
  Shape shape = Shape::ball;
  int count = 1;
  double radius_m = 1.0;
  double edge_m = 1.0;
  double guess = std::numeric_limits<double>::quiet_NaN();
  std::vector<Part> parts{};
};

template <template <class> class Walk>
void describe(Walk<Part>& s) {
  s.field("angle_deg", &Part::angle_rad, "where it points").unit("deg").range(-180, 180).scaled(0.0174532925);
}
template <template <class> class Walk>
void describe(Walk<Thing>& s) {
  s.field("name", &Thing::name, "what it is called").name();
  s.field("shape", &Thing::shape, "its form").words({{"ball", Shape::ball}, {"box", Shape::box}}).decides();
  s.field("count", &Thing::count, "how many").range(1, 5);
  s.field("radius_m", &Thing::radius_m, "of the ball").unit("m").range(0.1, 10).only_for({"ball"});
  s.field("edge_m", &Thing::edge_m, "of the box").unit("m").range(0.1, 10).only_for({"box"});
  s.field("guess", &Thing::guess, "anything").range(0, 1).nullable();
  s.field("parts", &Thing::parts, "what it is made of");
}

namespace {

std::string text_of(const Thing& thing) {
  const auto found = field_check<Thing>().complaint(thing);
  return found ? found->text() : "";
}

TEST(FieldCheck, NamesTheFirstValueThatIsNotAsDescribed) {
  EXPECT_EQ(text_of({}), "");
  EXPECT_EQ(text_of({.name = "a/b"}), "name: a/b: expected " + std::string(kNameForm));
  EXPECT_EQ(text_of({.shape = static_cast<Shape>(7)}), "shape: 7: expected one of ball, box");
  EXPECT_EQ(text_of({.count = 6}), "count: 6: expected a whole number from 1 to 5");
  EXPECT_EQ(text_of({.radius_m = 0.0}), "radius_m: 0: expected a number from 0.1 to 10");
  EXPECT_EQ(text_of({.guess = 2.0}), "guess: 2: expected a number from 0 to 1");
}

TEST(FieldCheck, RefusesWhatIsNoNumberUnlessItMayBeUnknown) {
  EXPECT_EQ(text_of({.radius_m = std::numeric_limits<double>::quiet_NaN()}),
            "radius_m: nan: expected a number from 0.1 to 10");
  EXPECT_EQ(text_of({.radius_m = std::numeric_limits<double>::infinity()}),
            "radius_m: inf: expected a number from 0.1 to 10");
}

TEST(FieldCheck, SpeaksInTheUnitOfTheKeyAndReachesIntoLists) {
  Thing thing;
  thing.parts = {{}, {.angle_rad = {0.0, 4.0 * 0.0174532925 * 100.0}}};
  EXPECT_EQ(text_of(thing), "parts.1.angle_deg.1: 400: expected a number from -180 to 180");
}

TEST(FieldCheck, TakesABoundAsAFileGivesIt) {
  Thing thing;
  thing.parts = {{.angle_rad = {180.0 * 0.0174532925, -180.0 * 0.0174532925}}};
  EXPECT_EQ(text_of(thing), "");
}

TEST(FieldCheck, LooksAtAFieldOnlyWhereItMeansSomething) {
  EXPECT_EQ(text_of({.shape = Shape::ball, .edge_m = 99.0}), "");
  EXPECT_EQ(text_of({.shape = Shape::box, .edge_m = 99.0}), "edge_m: 99: expected a number from 0.1 to 10");
}

}  // namespace
}  // namespace fathom
