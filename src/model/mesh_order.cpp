// SPDX-License-Identifier: Apache-2.0
#include "model/mesh_order.hpp"

#include <algorithm>
#include <numeric>

#include "model/patch_cut.hpp"
#include "parallel/parallel.hpp"

namespace fexp::model {

namespace {

/// Pieces larger than this are halved side by side.
constexpr std::size_t serial_centres = 16384;
constexpr Index centre_grain = 8192;

struct Centre {
  Vec3d point;
  Index triangle{};
};

/// Patches [first, last) of `count` in all; `centres` are their triangles.
void halve(std::span<Centre> centres, Index blocks, Index count, Index first, Index last) {
  if (last - first < 2) {
    std::ranges::sort(centres, {}, &Centre::triangle);
    return;
  }
  Box box;
  for (const Centre& centre : centres) {
    box.include(centre.point);
  }
  double Vec3d::*const axis = longest_axis(box);
  const Index middle = first + (last - first) / 2;
  const Index cut = block_lanes * (patch_begin(blocks, count, middle) - patch_begin(blocks, count, first));
  const auto half = centres.begin() + cut;
  std::nth_element(centres.begin(), half, centres.end(), [axis](const Centre& a, const Centre& b) {
    // A total order, so that the same mesh is cut the same way everywhere.
    return a.point.*axis != b.point.*axis ? a.point.*axis < b.point.*axis : a.triangle < b.triangle;
  });
  parallel::for_each(2, centres.size() > serial_centres ? 1 : 2, [&](Index side) {
    if (side == 0) {
      halve({centres.begin(), half}, blocks, count, first, middle);
    } else {
      halve({half, centres.end()}, blocks, count, middle, last);
    }
  });
}

}  // namespace

void order_by_place(const std::vector<Vec3d>& position, const std::vector<Triangle>& triangle, std::span<Index> order) {
  const Index blocks = (static_cast<Index>(order.size()) + block_lanes - 1) / block_lanes;
  const Index count = patch_count(blocks);
  if (count < 2) {
    return;
  }
  std::vector<Centre> centres(order.size());
  parallel::for_each(static_cast<Index>(order.size()), centre_grain, [&](Index i) {
    const Triangle& corners = triangle[at(order[at(i)])];
    // Three times the centre, which is as good.
    centres[at(i)] = {position[at(corners[0])] + position[at(corners[1])] + position[at(corners[2])], order[at(i)]};
  });
  halve(centres, blocks, count, 0, count);
  std::ranges::transform(centres, order.begin(), &Centre::triangle);
}

std::vector<Index> node_numbers(std::size_t nodes, std::span<const Triangle> triangle) {
  std::vector<Index> number(nodes, no_index);
  if (triangle.size() <= at(patch_elements)) {
    std::iota(number.begin(), number.end(), 0);
    return number;
  }
  Index next = 0;
  for (const Triangle& corners : triangle) {
    for (const Index n : corners) {
      if (number[at(n)] == no_index) {
        number[at(n)] = next++;
      }
    }
  }
  for (Index& n : number) {
    n = n == no_index ? next++ : n;
  }
  return number;
}

}  // namespace fexp::model
