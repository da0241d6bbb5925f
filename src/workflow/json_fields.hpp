// Converts structs to JSON and back. A template fields(ar, x) lists the keys and members of a struct once, in the order
// of the keys. With a JsonWriter it writes them, with a JsonReader it reads them.
#pragma once

#include <complex>
#include <concepts>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file_format.hpp"
#include "hamflow/scenario/value.hpp"
#include "hamflow/verify/long_number.hpp"

namespace hamflow {

class JsonWriter {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr bool reading = false;

  /// Writes keys and values, each key before its value. An optional without a value is written as null.
  template <class T, class... More>
  void operator()(const std::string& key, const T& x, const More&... more) {
    json_[key] = written(x);
    if constexpr (sizeof...(more) > 0) (*this)(more...);
  }
  /// Leaves the key out if an optional has no value, or a text or list is empty.
  template <class T>
  void if_any(const std::string& key, const T& x) {
    if constexpr (requires { x.has_value(); }) {
      if (x) json_[key] = written(*x);
    } else {
      if (!x.empty()) json_[key] = written(x);
    }
  }
  /// Writes the digits, as text, if there are any: most readers of JSON round numbers to double.
  void number(const std::string& key, double x, const std::string& digits) {
    json_[key] = digits.empty() ? Json(x) : Json(digits);
  }
  void numbers(const std::string& key, const std::vector<double>& x, const std::vector<std::string>& digits) {
    json_[key] = digits.empty() ? Json(x) : Json(digits);
  }
  /// Writes an object whose keys are the names of the elements.
  template <class T>
  void by_name(const std::string& key, const std::vector<T>& all) {
    Json object = Json::object();
    for (const T& each : all) object[each.name] = written(each);
    json_[key] = std::move(object);
  }
  /// Writes a text; an empty text is written as null.
  void text_or_null(const std::string& key, const std::string& x) { json_[key] = x.empty() ? Json(nullptr) : Json(x); }
  Json take() { return std::move(json_); }

  template <class T>
  static Json written(const std::vector<T>& all) {
    Json array = Json::array();
    for (const T& each : all) array.push_back(written(each));
    return array;
  }
  template <class T>
  static Json written(const std::vector<std::pair<std::string, T>>& all) {
    Json object = Json::object();
    for (const auto& [name, each] : all) object[name] = written(each);
    return object;
  }
  template <class T>
  static Json written(const std::optional<T>& x) {
    return x ? written(*x) : Json(nullptr);
  }
  static Json written(const LongNumber& x) { return x.text.empty() ? Json(x.value) : Json(x.text); }
  static Json written(const std::complex<double>& x) { return Json::array({x.real(), x.imag()}); }
  static Json written(const Value& x) {
    return std::visit([](const auto& content) { return written(content); }, x.content);
  }
  template <class T>
  static Json written(const T& x) {
    if constexpr (requires(JsonWriter ar, T & y) { fields(ar, y); }) {
      JsonWriter ar;
      fields(ar, const_cast<T&>(x));  // NOLINT: one list of fields serves both directions; a JsonWriter changes nothing
      return ar.take();
    } else {
      return Json(x);
    }
  }

 private:
  Json json_ = Json::object();
};

/// Reads members. A member whose key is missing keeps its value.
class JsonReader {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr bool reading = true;
  explicit JsonReader(const Json& json) : json_(json) {}

  bool has(const std::string& key) const { return json_.contains(key); }
  bool is_list(const std::string& key) const { return json_.at(key).is_array(); }
  template <class T, class... More>
  void operator()(const std::string& key, T& x, More&&... more) const {
    if (has(key)) read(json_[key], x);
    if constexpr (sizeof...(more) > 0) (*this)(more...);
  }
  template <class T>
  void if_any(const std::string& key, T& x) const {
    (*this)(key, x);
  }
  void number(const std::string& key, double& x, std::string& digits) const {
    LongNumber found;
    (*this)(key, found);
    x = found.value;
    digits = found.text;
  }
  void numbers(const std::string& key, std::vector<double>& x, std::vector<std::string>& digits) const {
    std::vector<LongNumber> all;
    (*this)(key, all);
    x.assign(all.begin(), all.end());
    digits.clear();
    for (const LongNumber& each : all) {
      if (!each.text.empty()) digits.push_back(each.text);
    }
  }
  template <class T>
  void by_name(const std::string& key, std::vector<T>& all) const {
    if (!has(key)) return;
    for (const auto& [name, each] : json_[key].items()) {
      read(each, all.emplace_back());
      all.back().name = name;
    }
  }
  void text_or_null(const std::string& key, std::string& x) const {
    if (has(key) && !json_[key].is_null()) (*this)(key, x);
  }

  /// Reads a list, or a single value.
  template <class T>
  static void read(const Json& json, std::vector<T>& all) {
    if (!json.is_array()) return read(json, all.emplace_back(blank<T>()));
    for (const Json& each : json) read(each, all.emplace_back(blank<T>()));
  }
  template <class T>
  static void read(const Json& json, std::vector<std::pair<std::string, T>>& all) {
    for (const auto& [name, each] : json.items()) read(each, all.emplace_back(name, blank<T>()).second);
  }
  template <class T>
  static void read(const Json& json, std::optional<T>& x) {
    if (!json.is_null()) read(json, x.emplace());
  }
  static void read(const Json& json, double& x) {
    x = json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
  }
  static void read(const Json& json, LongNumber& x) {
    if (!json.is_string()) return read(json, x.value);
    x.text = json.get<std::string>();
    x.value = std::strtod(x.text.c_str(), nullptr);
  }
  static void read(const Json& json, std::complex<double>& x) {
    double re = 0, im = 0;
    read(json.at(0), re);
    read(json.at(1), im);
    x = {re, im};
  }
  static void read(const Json& json, Value& x) {
    const auto take = [&]<class T>(T content) {
      read(json, content);
      x.content = std::move(content);
    };
    if (json.is_object()) return take(Value::Table());
    if (json.is_array()) return take(Value::List());
    if (json.is_string()) return take(std::string());
    if (json.is_boolean()) return take(bool());
    if (json.is_number_integer()) return take(std::int64_t());
    take(double());
  }
  template <class T>
  static void read(const Json& json, T& x) {
    if constexpr (requires(JsonReader ar) { fields(ar, x); }) {
      JsonReader ar(json);
      fields(ar, x);
    } else {
      json.get_to(x);
    }
  }

 private:
  template <class T>
  static T blank() {
    if constexpr (std::same_as<T, Value>) {
      return false;
    } else {
      return T{};
    }
  }

  const Json& json_;
};

/// The first key of every summary: the version of the format of hamflow's files.
/// @throws FileError if a later version of hamflow wrote a summary that this version cannot read
template <class Ar>
void format_of_file(Ar& ar) {
  std::string format = file_format;
  ar("format", format);
  if (const std::string wrong = refused_format(format); !wrong.empty()) throw FileError("the summary " + wrong);
}

}  // namespace hamflow
