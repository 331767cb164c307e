// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fexp {

/// Where in the input something stands; line and column count from 1, 0 means unknown.
struct Place {
  std::string file;
  int line{};
  int column{};

  /// "file:line:column", or as much of it as is known.
  [[nodiscard]] std::string text() const;
};

/// One thing wrong with the input: where, what was found, what is accepted, and what to do about it.
struct InputError {
  Place place;
  std::string message;   ///< What is wrong, with the field and the value found.
  std::string accepted;  ///< The accepted range or set; may be empty.
  std::string cure;      ///< What the user can do.

  /// "file:line:column: error: message; accepted: ...; cure: ...", one line.
  [[nodiscard]] std::string text() const;
};

/// Thrown with all independent errors of the input at once.
class InputErrors : public std::runtime_error {
 public:
  explicit InputErrors(std::vector<InputError> errors);
  [[nodiscard]] const std::vector<InputError>& errors() const noexcept { return errors_; }

 private:
  std::vector<InputError> errors_;
};

/// Gathers independent errors so that one run of the program names them all.
class ErrorList {
 public:
  void add(Place place, std::string message, std::string accepted, std::string cure) {
    errors_.push_back({std::move(place), std::move(message), std::move(accepted), std::move(cure)});
  }
  void add(InputError error) { errors_.push_back(std::move(error)); }
  [[nodiscard]] bool empty() const noexcept { return errors_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return errors_.size(); }
  [[nodiscard]] const std::vector<InputError>& errors() const noexcept { return errors_; }

  /// Throws InputErrors when anything was added.
  void throw_if_any() const;

 private:
  std::vector<InputError> errors_;
};

}  // namespace fexp
