// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "base/elementary.hpp"
#include "base/inline.hpp"
#include "base/pack.hpp"
#include "physics/c0_triangle.hpp"
#include "physics/j2_plane_stress.hpp"
#include "physics/layered_section.hpp"
#include "physics/yield_stress.hpp"

/// Shell sections whose resultants are sums over points through the thickness, each with a plastic law in plane stress.
/// Transverse shear and the drilling tie stay elastic.
namespace fexp::physics {

/// Stress and effective plastic strain of one point.
template <class T>
struct LayerPoint {
  PlaneTensor<T> stress;  ///< [force/length^2]
  T strain;               ///< [-]
};

/// What a step does with a point besides.
template <class T>
struct PointChange {
  T transverse_strain;  ///< Increment of the strain across the thickness [-]
  T plastic_work;       ///< [force/length^2]
};

/// What the points of an element have in common in a step.
template <class T>
struct LayerStep {
  // Copies, as compilers cannot know that what is stored of points leaves the section alone.
  J2Elasticity elasticity;
  double membrane_modulus;  ///< Of xx + yy [force/length^2]
  double shear_modulus;     ///< [force/length^2]
  RateDependence rate;
  /// What squared increments of strain are multiplied by to be squared rates over the squared reference rate.
  double inverse_rate;
  MaterialTurn<T> turn;

  FEXP_INLINE LayerStep(const LayeredSection& section, double dt, const T& gxy) noexcept
      : elasticity(section.elasticity),
        membrane_modulus(section.moduli.direct + section.moduli.cross),
        shear_modulus(section.moduli.shear),
        rate(section.plasticity.rate),
        inverse_rate(1.0 / (3.0 * (dt * rate.reference) * (dt * rate.reference))),
        turn(gxy) {}

  /// Stress as if the increments were elastic; it turns with the material as MaterialTurn::turn_tensor says.
  [[nodiscard]] FEXP_INLINE PlaneTensor<T> trial(const PlaneTensor<T>& old,
                                                 const PlaneTensor<T>& strain) const noexcept {
    const T shear(shear_modulus);
    const T half_difference = shear * strain.difference, added_shear = shear * strain.shear;
    const T mean_difference = T(0.5) * old.difference + T(0.5) * half_difference;
    const T mean_shear = old.shear + T(0.5) * added_shear;
    const T change = turn.phi * (turn.tensor_scale * (mean_shear - turn.phi * mean_difference));
    const T sheared = turn.phi * (mean_difference + change);
    const T twice = change + change;
    return {old.sum + T(membrane_modulus) * strain.sum,
            old.difference + ((half_difference + half_difference) + (twice + twice)),
            old.shear + (added_shear - (sheared + sheared))};
  }

  /// Effective rate of the whole strain without change of volume, 4/3 (exx^2 + exx eyy + eyy^2 + gxy^2/4), over the
  /// square of the reference rate.
  [[nodiscard]] FEXP_INLINE T squared_rate(const PlaneTensor<T>& strain) const noexcept {
    const T squares =
        T(3.0) * (strain.sum * strain.sum) + (strain.difference * strain.difference + strain.shear * strain.shear);
    return squares * T(inverse_rate);
  }
};

/// A yield stress times the factor of rate and temperature.
template <class T, class Curve>
struct RatedYield {
  YieldStress<T, Curve> still;
  T factor;
  T stress, slope;

  FEXP_INLINE RatedYield(const YieldStress<T, Curve>& at_rest, const T& by) noexcept
      : still(at_rest), factor(by), stress(factor * still.stress), slope(factor * still.slope) {}
  [[nodiscard]] FEXP_INLINE T after(const T& increment, T& derivative) const noexcept {
    const T value = still.after(increment, derivative);
    derivative = factor * derivative;
    return factor * value;
  }
};

/// Stress of a point after its strain increment. Its yield stress is that of the curve times `factor()`, which is asked
/// for only where the trial stress may be beyond it, and nowhere less than `least_stress`.
template <class T, class Curve, class Factor>
FEXP_INLINE PointChange<T> update_point(const LayerStep<T>& step, const Curve& curve, const PlaneTensor<T>& strain,
                                        const T& least_stress, const Factor& factor, LayerPoint<T>& p) noexcept {
  const PlaneTensor<T> trial = step.trial(p.stress, strain);
  const T before = p.strain, old_sum = p.stress.sum;
  const J2Return<T> r = return_to_yield<Curve::smooth>(step.elasticity, trial, least_stress, [&] {
    return RatedYield<T, Curve>(YieldStress<T, Curve>(curve, before), factor());
  });
  p.stress = {r.mean_factor * trial.sum, r.deviator_factor * trial.difference, r.deviator_factor * trial.shear};
  p.strain = before + r.strain;
  return {T(step.elasticity.transverse) * (p.stress.sum - old_sum) + r.transverse_strain * p.stress.sum,
          r.stress * r.strain};
}

/// The same where the section has no conditions.
template <class T, class Curve>
FEXP_INLINE PointChange<T> update_point(const LayerStep<T>& step, const Curve& curve, const PlaneTensor<T>& strain,
                                        LayerPoint<T>& p) noexcept {
  return update_point(
      step, curve, strain, T(curve.least()), [&] { return step.rate.johnson_cook(step.squared_rate(strain)); }, p);
}

/// What else the yield stress of a point depends on.
template <class T>
struct PointConditions {
  T temperature;  ///< [temperature]
  T rate;         ///< Of strain, filtered [1/time]
};

/// What a step does with the conditions of the points of a section.
struct ConditionStep {
  ThermalSoftening heat;
  bool filters;
  double filter_weight;
  double rate_unit;  ///< Reference rate [1/time]

  FEXP_INLINE ConditionStep(const J2Plasticity& plasticity, double dt) noexcept
      : heat(plasticity.heat),
        filters(plasticity.rate.filters()),
        filter_weight(filters ? plasticity.rate.filter_weight(dt) : 1.0),
        rate_unit(plasticity.rate.reference) {}

  /// Stress, temperature and filtered rate of a point after its strain increment. The yield stress is that of the
  /// temperature at the step's start, so that it does not fall while it is looked for.
  template <class T, class Curve>
  FEXP_INLINE PointChange<T> update(const LayerStep<T>& step, const Curve& curve, const PlaneTensor<T>& strain,
                                    LayerPoint<T>& p, PointConditions<T>& conditions) const noexcept {
    T square = step.squared_rate(strain);
    if (filters) {
      conditions.rate = conditions.rate + T(filter_weight) * (T(rate_unit) * square_root(square) - conditions.rate);
      const T ratio = conditions.rate * T(1.0 / rate_unit);
      square = ratio * ratio;
    }
    const T softening = heat.heats() ? heat.factor(conditions.temperature) : T(1.0);
    const T least = T(curve.least()) * softening;
    return update_point(
        step, curve, strain, least, [&] { return step.rate.factor(square) * softening; }, p);
  }

  template <class Load>
  [[nodiscard]] FEXP_INLINE auto load(const LayeredSection& section, int point, const Load& load_row) const noexcept {
    using T = decltype(load_row(0));
    return PointConditions<T>{heat.heats() ? load_row(section.temperature_row(point)) : T(0.0),
                              filters ? load_row(section.rate_row(point)) : T(0.0)};
  }
  /// What has become of them; the plastic work of the step heats.
  template <class T, class Store>
  FEXP_INLINE void store(const LayeredSection& section, int point, const PointConditions<T>& conditions,
                         const PointChange<T>& change, const Store& store_row) const noexcept {
    if (heat.heats()) {
      store_row(section.temperature_row(point), conditions.temperature + T(heat.heating) * change.plastic_work);
    }
    if (filters) {
      store_row(section.rate_row(point), conditions.rate);
    }
  }
};

/// A point whose strain has reached the failure strain carries nothing from then on; `before` is its strain at the
/// step's start. Returns 1 where it has failed, else 0.
template <class T>
[[nodiscard]] FEXP_INLINE T let_fail(double failure_strain, const T& before, LayerPoint<T>& p,
                                     PointChange<T>& change) noexcept {
  const T limit(failure_strain), zero(0.0);
  change.transverse_strain = select_less(before, limit, change.transverse_strain, zero);
  change.plastic_work = select_less(before, limit, change.plastic_work, zero);
  p.strain = select_less(before, limit, p.strain, before);
  for (T* const value : {&p.stress.sum, &p.stress.difference, &p.stress.shear}) {
    *value = select_less(p.strain, limit, *value, zero);
  }
  return select_less(p.strain, limit, zero, T(1.0));
}

/// Takes shear and drilling from elements that are deleted, 1 in `deleted`, and leaves the energy of those alone that
/// were so before. What became of their geometry does not matter, not even when it is no number.
template <class T>
FEXP_INLINE void clear_deleted(const T& deleted, const T& before, const T& energy, ShellResultants<T>& r) noexcept {
  const T half(0.5), zero(0.0);
  for (T* const value :
       {&r.nxx, &r.nyy, &r.nxy, &r.mxx, &r.myy, &r.mxy, &r.qxz, &r.qyz, &r.drill[0], &r.drill[1], &r.drill[2]}) {
    *value = select_less(deleted, half, *value, zero);
  }
  r.energy = select_less(before, half, r.energy, energy);
}

/// Sums over the points, to be multiplied by the thickness and by half its square.
template <class T>
struct LayerSums {
  PlaneTensor<T> force{T(0.0), T(0.0), T(0.0)}, moment{T(0.0), T(0.0), T(0.0)};
  T transverse_strain{0.0};
  T plastic_work{0.0};
  T failed{1.0};  ///< 1 where all points have failed

  FEXP_INLINE void add(double weight, double position, const LayerPoint<T>& p, const PointChange<T>& change) noexcept {
    const T w(weight), z(position);
    const T sum = w * p.stress.sum, difference = w * p.stress.difference, shear = w * p.stress.shear;
    force = {force.sum + sum, force.difference + difference, force.shear + shear};
    moment = {moment.sum + z * sum, moment.difference + z * difference, moment.shear + z * shear};
    transverse_strain = transverse_strain + w * change.transverse_strain;
    plastic_work = plastic_work + w * change.plastic_work;
  }
};

/// Resultants of a layered element after a step dt > 0; `load(r)` and `store(r, value)` read and write row r of its
/// history. `Conditions` as LayeredSection::has_conditions.
template <bool Conditions = false, class T, class Curve, class Load, class Store>
FEXP_INLINE void update_layered(const ShellStiffness& s, const LayeredSection& section, const Curve& curve, double dt,
                                const T& area, const ShellIncrement<T>& e, const Load& load, const Store& store,
                                ShellResultants<T>& r) noexcept {
  const LayerStep<T> step(section, dt, e.gxy);
  const double failure_strain = section.plasticity.failure_strain;
  const bool can_fail = section.plasticity.can_fail();
  const T thickness = load(layer_thickness), half_thickness = T(0.5) * thickness;
  const PlaneTensor<T> membrane{e.exx + e.eyy, e.exx - e.eyy, e.gxy};
  const PlaneTensor<T> curvature{e.kxx + e.kyy, e.kxx - e.kyy, e.kxy};
  LayerSums<T> sums;
  [[maybe_unused]] const ConditionStep point_conditions(section.plasticity, dt);
  for (int i = 0; i < section.points.count; ++i) {
    const double position = section.points.position[static_cast<std::size_t>(i)];
    const int row = layer_points + i * point_rows;
    LayerPoint<T> p{{load(row + point_sum), load(row + point_difference), load(row + point_shear)},
                    load(row + point_strain)};
    const T z = half_thickness * T(position), before = p.strain;
    const PlaneTensor<T> strain{membrane.sum + z * curvature.sum, membrane.difference + z * curvature.difference,
                                membrane.shear + z * curvature.shear};
    PointConditions<T> conditions{T(0.0), T(0.0)};
    PointChange<T> change{T(0.0), T(0.0)};
    if constexpr (Conditions) {
      conditions = point_conditions.load(section, i, load);
      change = point_conditions.update(step, curve, strain, p, conditions);
    } else {
      change = update_point(step, curve, strain, p);
    }
    if (can_fail) {
      sums.failed = minimum(sums.failed, let_fail(failure_strain, before, p, change));
      conditions.rate = select_less(p.strain, T(failure_strain), conditions.rate, T(0.0));
    }
    if constexpr (Conditions) {
      point_conditions.store(section, i, conditions, change, store);
    }
    store(row + point_sum, p.stress.sum);
    store(row + point_difference, p.stress.difference);
    store(row + point_shear, p.stress.shear);
    store(row + point_strain, p.strain);
    sums.add(section.points.weight[static_cast<std::size_t>(i)], position, p, change);
  }
  // The exponential of the strain to third order.
  T new_thickness = thickness * ((T(2.0) + sums.transverse_strain) / (T(2.0) - sums.transverse_strain));
  T dissipation = load(layer_dissipation) + area * (thickness * sums.plastic_work);

  const ShellResultants<T> old = r;
  const T half = T(0.5) * new_thickness, arm = half * half;
  r.nxx = half * (sums.force.sum + sums.force.difference);
  r.nyy = half * (sums.force.sum - sums.force.difference);
  r.nxy = new_thickness * sums.force.shear;
  r.mxx = arm * (sums.moment.sum + sums.moment.difference);
  r.myy = arm * (sums.moment.sum - sums.moment.difference);
  r.mxy = (arm + arm) * sums.moment.shear;
  const T density = T(0.5) * (((old.nxx + r.nxx) * e.exx + (old.nyy + r.nyy) * e.eyy + (old.nxy + r.nxy) * e.gxy) +
                              ((old.mxx + r.mxx) * e.kxx + (old.myy + r.myy) * e.kyy + (old.mxy + r.mxy) * e.kxy));
  update_shear_and_drilling(s, area, e, step.turn, density, r);
  if (can_fail) {
    const T before = load(layer_deleted);
    new_thickness = select_less(before, T(0.5), new_thickness, thickness);
    dissipation = select_less(before, T(0.5), dissipation, load(layer_dissipation));
    const T deleted = maximum(before, sums.failed);
    clear_deleted(deleted, before, old.energy, r);
    store(layer_deleted, select_less(T(0.5), deleted, minimum(before + T(1.0), T(2.0)), T(0.0)));
  }
  store(layer_thickness, new_thickness);
  store(layer_dissipation, dissipation);
}

}  // namespace fexp::physics
