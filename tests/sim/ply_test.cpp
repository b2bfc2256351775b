#include "sim/ply.h"

#include "tests/testing.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <limits>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;

const std::string triangle_body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A text file of three vertices and one face; `vertex_extra` and `face_list` change its header.
std::string triangle_text(const std::string& body = triangle_body, const std::string& vertex_extra = "",
                          const std::string& face_list = "property list uchar int vertex_indices\n") {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
         vertex_extra + "element face 1\n" + face_list + "end_header\n" + body;
}

std::string refusal(const std::string& bytes) {
  return input_error([&] { read_ply(bytes, "a.ply"); });
}

Mesh random_mesh(bool with_texture) {
  auto generator = testing::generator();
  std::uniform_real_distribution<double> coordinate(-1e3, 1e3);
  Mesh mesh;
  for (int i = 0; i < 50; ++i) {
    mesh.positions.emplace_back(coordinate(generator), coordinate(generator), coordinate(generator));
    if (with_texture) mesh.texture_coordinates.emplace_back(coordinate(generator), coordinate(generator));
  }
  for (int i = 0; i < 70; ++i)
    mesh.triangles.emplace_back(generator() % 50, generator() % 50, generator() % 50);
  return mesh;
}

template <class T>
void append(std::string& bytes, T value, bool big_endian) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

std::string header_of(const std::string& encoding, const std::string& lines) {
  return "ply\nformat " + encoding + " 1.0\n" + lines + "end_header\n";
}

TEST(Ply, ReadsTextByHand) {
  const Mesh mesh = read_ply(triangle_text("0.1 +2 -3e-2\n1 0 0\n\n 0\t1 0 \r\n3 2 0 1"), "a.ply");
  ASSERT_EQ(mesh.positions.size(), 3U);
  EXPECT_EQ(mesh.positions[0], glm::dvec3(0.1, 2, -0.03));  // as doubles, though the header says float
  EXPECT_EQ(mesh.positions[2], glm::dvec3(0, 1, 0));
  EXPECT_EQ(mesh.triangles, std::vector<glm::uvec3>({{2, 0, 1}}));
  EXPECT_TRUE(mesh.texture_coordinates.empty());
}

TEST(Ply, ReadsAHeaderWithWindowsLineEnds) {
  std::string text = triangle_text();
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.replace(at, 1, "\r\n");
  EXPECT_EQ(read_ply(text, "a.ply").triangles.size(), 1U);
}

TEST(Ply, ReadsTextureCoordinatesByEachOfTheirNames) {
  const std::string body = "0 0 0 .25 .5\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
  for (const auto& [s, t] : {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}}) {
    const std::string extra = std::string("property float32 ") + s + "\nproperty float64 " + t + "\n";
    const Mesh mesh = read_ply(triangle_text(body, extra), "a.ply");
    ASSERT_EQ(mesh.texture_coordinates.size(), 3U) << s;
    EXPECT_EQ(mesh.texture_coordinates[0], glm::dvec2(0.25, 0.5)) << s;
  }
}

TEST(Ply, PassesOverForeignPropertiesAndElements) {
  const std::string text =
      "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement camera 2\nproperty int id\n"
      "property list uchar float knots\nelement nothing 1000000000000\nelement vertex 3\nproperty uchar red\n"
      "property double z\nproperty int y\nproperty list int8 int16 friends\nproperty short x\n"
      "element face 1\nproperty float quality\nproperty list uint uint vertex_index\nproperty list uchar "
      "float w\n"
      "end_header\n7 2 0.5 0.25\n8 0\n255 0.5 1 0 2\n255 0 1 2 7 7 3\n255 0 0 1 9 4\n0.5 3 0 1 2 1 0.5\n";
  const Mesh mesh = read_ply(text, "a.ply");
  EXPECT_EQ(mesh.positions, std::vector<glm::dvec3>({{2, 1, 0.5}, {3, 1, 0}, {4, 0, 0}}));
  EXPECT_EQ(mesh.triangles, std::vector<glm::uvec3>({{0, 1, 2}}));
}

TEST(Ply, CutsAPolygonIntoAFan) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty int x\nproperty int y\nproperty int z\nelement face "
      "1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n2 0 0\n3 1 0\n2 2 0\n0 2 0\n5 0 1 2 3 4\n";
  EXPECT_EQ(read_ply(text, "a.ply").triangles, std::vector<glm::uvec3>({{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Ply, ReadsBothByteOrdersAndEachType) {
  for (const bool big : {false, true}) {
    std::string bytes = header_of(
        big ? "binary_big_endian" : "binary_little_endian",
        "element face 1\nproperty list int16 uint16 vertex_indices\nelement vertex 3\nproperty char x\n"
        "property list uchar double skipped\nproperty uint8 y\nproperty float z\nproperty int32 s\nproperty "
        "uint t\n"
        "element edge 1\nproperty int64x id\n");
    bytes.replace(bytes.find("int64x"), 6, "double");
    append(bytes, std::int16_t(3), big);
    for (const std::uint16_t index : {2, 0, 1}) append(bytes, index, big);
    for (int i = 0; i < 3; ++i) {
      append(bytes, std::int8_t(-i), big);
      append(bytes, std::uint8_t(1), big);
      append(bytes, 0.5, big);
      append(bytes, std::uint8_t(200 + i), big);
      append(bytes, 0.25F, big);
      append(bytes, std::int32_t(-70000), big);
      append(bytes, std::uint32_t(4000000000U), big);
    }
    append(bytes, 1.0, big);
    const Mesh mesh = read_ply(bytes, "a.ply");
    EXPECT_EQ(mesh.positions, std::vector<glm::dvec3>({{0, 200, 0.25}, {-1, 201, 0.25}, {-2, 202, 0.25}}));
    EXPECT_EQ(mesh.triangles, std::vector<glm::uvec3>({{2, 0, 1}}));
    EXPECT_EQ(mesh.texture_coordinates[2], glm::dvec2(-70000, 4000000000.0));
  }
}

TEST(Ply, WhatIsWrittenComesBackBitByBit) {
  for (const bool with_texture : {false, true}) {
    Mesh mesh = random_mesh(with_texture);
    mesh.positions[0] = {-0.0, 5e-324, 1.7976931348623157e308};
    const Mesh back = read_ply(ply_bytes(mesh), "a.ply");
    ASSERT_EQ(back.positions.size(), mesh.positions.size());
    EXPECT_EQ(std::memcmp(back.positions.data(), mesh.positions.data(), mesh.positions.size() * 24), 0);
    EXPECT_EQ(back.texture_coordinates, mesh.texture_coordinates);
    EXPECT_EQ(back.triangles, mesh.triangles);
  }
}

TEST(Ply, ReadsTheCubeThatShips) {
  std::string text;
  std::FILE* file = std::fopen((laterna::testing::data_folder() / "meshes/cube.ply").c_str(), "rb");
  ASSERT_NE(file, nullptr);
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += char(c);
  std::fclose(file);
  const Mesh mesh = read_ply(text, "cube.ply");
  EXPECT_EQ(mesh.positions.size(), 24U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_EQ(mesh.texture_coordinates[2], glm::dvec2(1, 1));
  EXPECT_EQ(validate(mesh, "cube.ply").degenerate_triangles, 0U);
}

TEST(Ply, RefusesHeadersWithASentenceEach) {
  const auto header = [](const std::string& lines) { return refusal("ply\n" + lines + "end_header\n"); };
  EXPECT_EQ(refusal(""), "a.ply, line 1: expected `ply`: this is no PLY file");
  EXPECT_EQ(refusal("solid\n"), "a.ply, line 1: expected `ply`: this is no PLY file");
  EXPECT_EQ(refusal("ply\nformat ascii 1.0\n"), "a.ply: the PLY header has no `end_header` line");
  EXPECT_EQ(header(""), "a.ply: the PLY header has no `format` line");
  EXPECT_EQ(header("format ascii 2.0\n"), "a.ply, line 2: expected `format <encoding> 1.0`");
  EXPECT_THAT(header("format morse 1.0\n"), HasSubstr("line 2: unknown encoding `morse`, expected ascii,"));
  EXPECT_EQ(header("format ascii 1.0\nformat ascii 1.0\n"), "a.ply, line 3: a second `format`, expected one");
  EXPECT_THAT(header("format ascii 1.0\nobject 3\n"), HasSubstr("line 3: unknown word `object`, expected"));
  EXPECT_THAT(header("format ascii 1.0\nelement face\n"),
              HasSubstr("line 3: expected `element <name> <count>`"));
  EXPECT_EQ(header("element face -1\n"), "a.ply, line 2: the count is `-1`, expected a whole number from 0");
  EXPECT_THAT(header("element face 1e3\n"), HasSubstr("the count is `1e3`"));
  EXPECT_EQ(header("element face 1\nelement face 1\n"),
            "a.ply, line 3: a second element `face`, expected one");
  EXPECT_EQ(header("property int x\n"), "a.ply, line 2: a property before the first element");
  EXPECT_THAT(header("element face 1\nproperty int\n"),
              HasSubstr("line 3: expected `property <type> <name>` or"));
  EXPECT_THAT(header("element face 1\nproperty real x\n"),
              HasSubstr("line 3: unknown type `real`, expected char,"));
  EXPECT_EQ(header("element face 1\nproperty list float int i\n"),
            "a.ply, line 3: a list counted in floats, expected an integer type");
  EXPECT_EQ(header("element face 1\nproperty int x\nproperty int x\n"),
            "a.ply, line 4: a second property `x`, expected one");
}

TEST(Ply, RefusesMissingElementsAndProperties) {
  EXPECT_EQ(refusal(header_of("ascii", "element face 0\n")),
            "a.ply: the header has no element `vertex`, expected vertex and face");
  EXPECT_EQ(refusal(header_of("ascii", "element vertex 0\n")),
            "a.ply: the header has no element `face`, expected vertex and face");
  EXPECT_EQ(refusal(header_of("ascii", "element vertex 0\nproperty int x\nproperty int y\nelement face 0\n")),
            "a.ply: element `vertex` lacks one of the properties x, y and z");
  EXPECT_EQ(refusal(triangle_text(triangle_body, "", "property list uchar float vertex_indices\n")),
            "a.ply: element `face` has no list of integers named vertex_indices or vertex_index");
}

TEST(Ply, RefusesCountsThatTheBytesCannotHold) {
  const std::string lines =
      "element vertex 1000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 0\n";
  EXPECT_EQ(refusal(header_of("binary_little_endian", lines) + std::string(40, '\0')),
            "a.ply: the header declares 1000000000 records of `vertex`, at least 12 bytes each, but 40 bytes "
            "are left "
            "for them: the file is truncated or its header wrong");
  EXPECT_THAT(refusal(header_of("ascii", lines) + "0 0 0\n"),
              HasSubstr("declares 1000000000 records of `vertex`"));
  const std::string many =
      "element vertex 0\nelement face 18446744073709551615\nproperty list char int vertex_index\n";
  EXPECT_THAT(refusal(header_of("binary_big_endian", many)),
              HasSubstr("declares 18446744073709551615 records"));
}

TEST(Ply, RefusesTextRecordsWithTheirLine) {
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: too few values for its properties");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 0 5\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: `5` is one value too many");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 x0 0\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: `x0`, expected a number");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0.5mm 0\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: `0.5mm`, expected a number");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 +-5 0\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: `+-5`, expected a number");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: `y` is nan, expected a finite number");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 -inf\n0 1 0\n3 0 1 2\n")),
            "a.ply, line 11: `z` is -inf, expected a finite number");
  EXPECT_THAT(refusal(triangle_text("0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n")), HasSubstr("a.ply, line 11: `"));
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")),
            "a.ply, line 13: a corner at vertex 3, but there are 3 vertices, counted from 0");
  EXPECT_THAT(refusal(triangle_text("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n")),
              HasSubstr("a corner at vertex -1, but"));
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 0\n0 1 0\n2 0 1\n")),
            "a.ply, line 13: a face with 2 corners, expected at least 3");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 0\n0 1 0\n256 0 1 2\n")),
            "a.ply, line 13: `256` does not fit the type that the header declares");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n")),
            "a.ply, line 13: `1.5`, expected a whole number");
  EXPECT_EQ(refusal(triangle_text("0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "",
                                  "property list char int vertex_indices\n")),
            "a.ply, line 13: the list `vertex_indices` has -3 entries, expected 0 or more");
  EXPECT_EQ(refusal(triangle_text("0.00000 0.00000 0\n1 0 0\n0 1 0\n")),
            "a.ply: ends after line 12 with 0 of 1 records of `face`: the file is truncated");
  EXPECT_EQ(refusal(triangle_text(triangle_body + "\n3 0 1 2\n")),
            "a.ply, line 15: `3` follows the last record, expected nothing");
}

TEST(Ply, RefusesBinaryRecordsWithTheirNumber) {
  const Mesh mesh = random_mesh(false);
  const std::string good = ply_bytes(mesh);
  EXPECT_EQ(refusal(good + "xyz"), "a.ply: 3 bytes follow the last record, expected the end of the file");
  EXPECT_EQ(refusal(good.substr(0, good.size() - 1)),
            "a.ply, face 69: the file ends inside this record: it is truncated");
  const std::size_t faces = good.size() - 70 * 13;
  std::string bad = good;
  bad[faces + 2 * 13] = 2;
  EXPECT_EQ(refusal(bad), "a.ply, face 2: a face with 2 corners, expected at least 3");
  bad = good;
  bad[faces + 4] = 1;
  EXPECT_THAT(refusal(bad), HasSubstr("a.ply, face 0: a corner at vertex 167772"));
  Mesh with_nan = mesh;
  with_nan.positions[17].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal(ply_bytes(with_nan)), "a.ply, vertex 17: `y` is nan, expected a finite number");
}

TEST(Ply, RefusesAFileCutAtAnyByte) {
  const std::string good = ply_bytes(random_mesh(true));
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(refusal(good.substr(0, size)).empty()) << "cut to " << size << " bytes";
}

TEST(Ply, DamagedBytesAreReadOrRefusedAndNothingElse) {
  auto generator = testing::generator();
  const std::string text =
      triangle_text("0 0 0 1 1 2\n1 0 0 0\n0 1 0 0\n3 0 1 2\n", "property list char int extra\n");
  const std::string seeds[] = {ply_bytes(random_mesh(true)).substr(0, 400),
                               ply_bytes({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}}), text};
  int refused = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string bytes = seeds[i % 3];
    for (std::uint64_t flips = 1 + generator() % 3; flips > 0; --flips)
      bytes[generator() % bytes.size()] = char(generator());
    try {
      const Mesh mesh = read_ply(bytes, "a.ply");
      EXPECT_LE(mesh.positions.size() + mesh.triangles.size(), bytes.size());
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 3000);  // two bytes in three stand where a change shows: header, counts, indices
}

}  // namespace
}  // namespace laterna
