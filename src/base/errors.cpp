// SPDX-License-Identifier: Apache-2.0
#include "base/errors.hpp"

#include <fmt/format.h>

namespace fexp {

namespace {

std::string joined(const std::vector<InputError>& errors) {
  std::string text;
  for (const InputError& error : errors) {
    if (!text.empty()) {
      text += '\n';
    }
    text += error.text();
  }
  return text;
}

}  // namespace

std::string Place::text() const {
  if (line <= 0) {
    return file;
  }
  return column > 0 ? fmt::format("{}:{}:{}", file, line, column) : fmt::format("{}:{}", file, line);
}

std::string InputError::text() const {
  std::string text = place.text();
  text += text.empty() ? "error: " : ": error: ";
  text += message;
  if (!accepted.empty()) {
    text += "; accepted: " + accepted;
  }
  if (!cure.empty()) {
    text += "; cure: " + cure;
  }
  return text;
}

InputErrors::InputErrors(std::vector<InputError> errors)
    : std::runtime_error(joined(errors)), errors_(std::move(errors)) {}

void ErrorList::throw_if_any() const {
  if (!errors_.empty()) {
    throw InputErrors(errors_);
  }
}

}  // namespace fexp
