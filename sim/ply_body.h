// The records of a PLY file, value by value. Only sim/ply.cpp and sim/formats/point_cloud.cpp need it.
//
// TextBody and BinaryBody offer the same functions, so that a template reads either: begin_record, then
// number, integer or skip for each property in the header's order, then end_record; end_body after the last.
// What does not go as the header says is an InputError that names the line or the record.
#pragma once

#include "sim/error.h"
#include "sim/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

namespace laterna::ply {

/// Whether a whole number fits the integer type that the header declares.
inline bool fits(std::int64_t value, Type type) {
  const int bits = 8 * int(size_in_bytes(type));
  const bool is_signed = type == Type::int8 || type == Type::int16 || type == Type::int32;
  const std::int64_t low = is_signed ? -(std::int64_t(1) << (bits - 1)) : 0;
  return value >= low && value <= low + ((std::int64_t(1) << bits) - 1);
}

/// The records of a text, one a line.
class TextBody {
 public:
  TextBody(std::string_view bytes, const Header& header, const std::string& name)
      : next_(bytes.data() + header.body_offset),
        end_(bytes.data() + bytes.size()),
        line_(header.line_count),
        name_(name) {}

  void begin_record(const Element& element, std::uint64_t index) {
    if (next_line()) return;
    throw InputError(
        fmt::format("{}: ends after line {} with {} of {} records of `{}`: the file is truncated", name_,
                    line_, index, element.count, element.name));
  }
  void end_record() {
    skip_blanks();
    if (at_ != line_end_) fail(fmt::format("`{}` is one value too many", word()));
  }
  void end_body() {
    if (next_line()) fail(fmt::format("`{}` follows the last record, expected nothing", word()));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}, line {}: {}", name_, line_, what));
  }

  double number(Type type) {
    if (is_integer(type)) return double(integer(type));
    return parse<double>("a number");
  }
  std::int64_t integer(Type type) {
    const char* start = at_;
    const auto value = parse<std::int64_t>("a whole number");
    if (!fits(value, type)) {
      at_ = start;
      fail(fmt::format("`{}` does not fit the type that the header declares", word()));
    }
    return value;
  }
  void skip(Type /*type*/, std::uint64_t count) {
    for (; count > 0; --count) {
      expect_value();
      while (at_ != line_end_ && !is_blank(*at_)) ++at_;
    }
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  void skip_blanks() {
    while (at_ != line_end_ && is_blank(*at_)) ++at_;
  }
  void expect_value() {
    skip_blanks();
    if (at_ == line_end_) fail("too few values for its properties");
  }

  /// Goes to the next line that is not empty; false at the end.
  bool next_line() {
    while (next_ != end_) {
      const void* found = std::memchr(next_, '\n', std::size_t(end_ - next_));
      at_ = next_;
      line_end_ = found ? static_cast<const char*>(found) : end_;
      next_ = found ? line_end_ + 1 : end_;
      ++line_;
      skip_blanks();
      if (at_ != line_end_) return true;
    }
    return false;
  }

  /// The word at hand, cut short and without control characters, fit for a message.
  std::string word() {
    skip_blanks();
    const char* stop = std::find_if(at_, line_end_, is_blank);
    std::string text(at_, std::min(stop, at_ + std::min<std::ptrdiff_t>(line_end_ - at_, 40)));
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
    return text;
  }

  template <class T>
  T parse(const char* expected) {
    expect_value();
    T value{};
    const char* start = *at_ == '+' && at_ + 1 != line_end_ && at_[1] != '-' ? at_ + 1 : at_;
    const auto [rest, error] = std::from_chars(start, line_end_, value);
    if (error != std::errc{} || (rest != line_end_ && !is_blank(*rest)))
      fail(fmt::format("`{}`, expected {}", word(), expected));
    at_ = rest;
    return value;
  }

  const char *next_, *end_;
  const char *at_ = nullptr, *line_end_ = nullptr;
  std::size_t line_;
  const std::string& name_;
};

/// The records of a binary file, one after the other.
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, const Header& header, const std::string& name)
      : rest_(bytes.substr(header.body_offset)),
        swap_((header.encoding == Encoding::big_endian) != (std::endian::native == std::endian::big)),
        name_(name) {}

  void begin_record(const Element& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  void end_record() {}
  void end_body() const {
    if (rest_.empty()) return;
    throw InputError(fmt::format("{}: {} bytes follow the last record, expected the end of the file", name_,
                                 rest_.size()));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}, {} {}: {}", name_, element_->name, index_, what));
  }

  double number(Type type) {
    if (type == Type::float32) return take<float>();
    if (type == Type::float64) return take<double>();
    return double(integer(type));
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      default:
        return take<std::uint32_t>();
    }
  }
  void skip(Type type, std::uint64_t count) { drop(count * size_in_bytes(type)); }

 private:
  void drop(std::uint64_t size) {
    if (rest_.size() < size) fail("the file ends inside this record: it is truncated");
    rest_.remove_prefix(size);
  }

  template <class T>
  T take() {
    std::array<char, sizeof(T)> bytes{};
    const char* start = rest_.data();
    drop(sizeof(T));
    std::copy_n(start, sizeof(T), bytes.begin());
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  std::string_view rest_;
  bool swap_;
  const std::string& name_;
  const Element* element_ = nullptr;
  std::uint64_t index_ = 0;
};

/// The count that begins a list.
template <class Body>
std::uint64_t list_count(Body& body, const Property& list) {
  const std::int64_t count = body.integer(list.count_type.value_or(Type::uint8));
  if (count < 0) body.fail(fmt::format("the list `{}` has {} entries, expected 0 or more", list.name, count));
  return std::uint64_t(count);
}

template <class Body>
void skip(Body& body, const Property& property) {
  body.skip(property.type, property.count_type ? list_count(body, property) : 1);
}

/// All records of an element; of one without properties there are none in the file.
template <class Body>
void skip_element(Body& body, const Element& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    body.begin_record(element, i);
    for (const Property& property : element.properties) skip(body, property);
    body.end_record();
  }
}

/// Index of the property named so among an element's; -1: none.
inline int find_property(const Element& element, std::string_view name) {
  const auto& all = element.properties;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Property& p) { return p.name == name; });
  return found == all.end() ? -1 : int(found - all.begin());
}

}  // namespace laterna::ply
