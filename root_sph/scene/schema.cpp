// SPDX-License-Identifier: MIT
#include "root_sph/scene/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/presets.hpp"

namespace rootsoil {
namespace {

// ---- limits ---------------------------------------------------------------------------------------

Limits above(double low) { return {.low = low, .low_open = true, .above_remedy = {}}; }
Limits at_least(double low) { return {.low = low, .above_remedy = {}}; }
Limits between(double low, double high) { return {.low = low, .high = high, .above_remedy = {}}; }
Limits inside(double low, double high) {
  return {.low = low, .high = high, .low_open = true, .high_open = true, .above_remedy = {}};
}
const Limits any_number;

constexpr const char* microns = "are these microns? 10 um are 0.01 mm";
constexpr const char* pascals = "are these Pa or kPa? 1 MPa = 1000 kPa = 1e6 Pa";
constexpr const char* seconds = "are these seconds? 3600 s are 1 h";

/// What a key accepts: a range, or a list of words.
struct Allowed {
  Limits limits;
  std::vector<std::string> choices;
  Allowed(Limits range) : limits(std::move(range)) {}
  Allowed(std::vector<std::string> words) : choices(std::move(words)) {}
};

Allowed one_of(std::vector<std::string> words) { return {std::move(words)}; }

// ---- struct members as values ---------------------------------------------------------------------

template <class T, ValueType Type, class Stored = T>
struct PlainCodec {
  static constexpr ValueType type = Type;
  static T read(const Value& value) { return static_cast<T>(std::get<Stored>(value)); }
  static std::optional<Value> write(const T& member) { return Value(static_cast<Stored>(member)); }
};

template <class T>
struct Codec;
template <>
struct Codec<bool> : PlainCodec<bool, ValueType::boolean> {};
template <>
struct Codec<int> : PlainCodec<int, ValueType::integer, std::int64_t> {};
template <>
struct Codec<std::int64_t> : PlainCodec<std::int64_t, ValueType::integer> {};
template <>
struct Codec<double> : PlainCodec<double, ValueType::number> {};
template <>
struct Codec<Texts> : PlainCodec<Texts, ValueType::texts> {};
template <>
struct Codec<std::string> : PlainCodec<std::string, ValueType::text> {
  static std::optional<Value> write(const std::string& member) {
    return member.empty() ? std::nullopt : std::optional<Value>(member);
  }
};
template <std::size_t N>
struct Codec<std::array<double, N>> {
  static constexpr ValueType type = N == 2 ? ValueType::pair : ValueType::vector;
  static std::array<double, N> read(const Value& value) {
    const Numbers& numbers = std::get<Numbers>(value);
    std::array<double, N> member{};
    std::copy_n(numbers.begin(), std::min(N, numbers.size()), member.begin());
    return member;
  }
  static std::optional<Value> write(const std::array<double, N>& member) {
    return Value(Numbers(member.begin(), member.end()));
  }
};
template <class T>
struct Codec<std::optional<T>> {
  static constexpr ValueType type = Codec<T>::type;
  static std::optional<T> read(const Value& value) { return Codec<T>::read(value); }
  static std::optional<Value> write(const std::optional<T>& member) {
    return member ? Codec<T>::write(*member) : std::nullopt;
  }
};

// ---- keys -----------------------------------------------------------------------------------------

template <class S>
struct Key {
  KeySpec spec;
  std::function<void(S&, const Value&)> set;
  std::function<std::optional<Value>(const S&)> get;

  Key required() && {
    spec.required = true;
    spec.default_text = "required";
    return std::move(*this);
  }
  Key defaults_to(std::string text) && {
    spec.default_text = std::move(text);
    return std::move(*this);
  }
  Key only_with(std::string key) && { return std::move(*this).when({std::move(key), {}, false}); }
  Key only_without(std::string key) && { return std::move(*this).when({std::move(key), {}, true}); }
  Key only_where(std::string key, std::vector<std::string> values) && {
    return std::move(*this).when({std::move(key), std::move(values), false});
  }
  Key or_from_response(std::string section) && {
    spec.response_section = std::move(section);
    return std::move(*this);
  }
  Key written_when(bool (*needed)(const S&)) && {
    get = [needed, get = std::move(get)](const S& s) { return needed(s) ? get(s) : std::nullopt; };
    return std::move(*this);
  }

 private:
  Key when(Condition condition) && {
    spec.condition = std::move(condition);
    return std::move(*this);
  }
};

template <class S, class T>
Key<S> key(T S::*member, std::string name, std::string unit, Allowed allowed, std::string meaning, std::string source) {
  using C = Codec<T>;
  Key<S> k;
  k.spec.name = std::move(name);
  k.spec.type = C::type;
  k.spec.unit = std::move(unit);
  k.spec.limits = std::move(allowed.limits);
  k.spec.choices = std::move(allowed.choices);
  k.spec.meaning = std::move(meaning);
  k.spec.source = std::move(source);
  k.set = [member](S& s, const Value& value) { s.*member = C::read(value); };
  k.get = [member](const S& s) { return C::write(s.*member); };
  const std::optional<Value> value_by_default = k.get(S{});
  k.spec.default_text = value_by_default ? toml_text(*value_by_default) : "none";
  return k;
}

/// A member of a base as a member of the section that inherits it.
template <class S, class T, class Base>
T S::*member_of(T Base::*member) {
  return member;
}

// ---- sections -------------------------------------------------------------------------------------

// A section is a struct, an optional struct or a list of structs.
template <class S>
std::size_t count_of(const S&) {
  return 1;
}
template <class S>
std::size_t count_of(const std::optional<S>& section) {
  return section ? 1 : 0;
}
template <class S>
std::size_t count_of(const std::vector<S>& section) {
  return section.size();
}

template <class S>
auto& element_of(S& section, std::size_t) {
  return section;
}
template <class S>
S& element_of(std::optional<S>& section, std::size_t) {
  return *section;
}
template <class S>
const S& element_of(const std::optional<S>& section, std::size_t) {
  return *section;
}
template <class S>
S& element_of(std::vector<S>& section, std::size_t index) {
  return section[index];
}
template <class S>
const S& element_of(const std::vector<S>& section, std::size_t index) {
  return section[index];
}

template <class S>
void add_to(S&) {}
template <class S>
void add_to(std::optional<S>& section) {
  section = S{};
}
template <class S>
void add_to(std::vector<S>& section) {
  section.emplace_back();
}

/// `where` gives the section's place in a scene, nullptr where the section around it is absent.
template <class S, class Where>
SectionSpec section(std::string name, SectionKind kind, std::string meaning, Where where, std::vector<Key<S>> keys) {
  SectionSpec spec{
      .name = std::move(name), .kind = kind, .meaning = std::move(meaning), .keys = {}, .count = {}, .add = {}};
  spec.count = [where](const Scene& scene) { return where(scene) ? count_of(*where(scene)) : 0; };
  spec.add = [where](Scene& scene) { add_to(*where(scene)); };
  for (Key<S>& k : keys) {
    spec.keys.push_back(std::move(k.spec));
    spec.keys.back().set = [where, set = std::move(k.set)](Scene& scene, std::size_t index, const Value& value) {
      set(element_of(*where(scene), index), value);
    };
    spec.keys.back().get = [where, get = std::move(k.get)](const Scene& scene, std::size_t index) {
      return get(element_of(*where(scene), index));
    };
  }
  return spec;
}

/// [pressure] has one table and two ways to write it.
Key<PressureSection> constant_pressure(Limits limits) {
  Key<PressureSection> k;
  k.spec = {.name = "differential_MPa",
            .type = ValueType::number,
            .unit = "MPa",
            .limits = std::move(limits),
            .choices = {},
            .meaning = "Constant pressure differential: turgor less what the soil takes; this or table.",
            .source = "paper Eq. 5, Table 1",
            .default_text = "none",
            .condition = {},
            .response_section = {},
            .set = {},
            .get = {}};
  k.set = [](PressureSection& s, const Value& value) { s.table = {{0.0, std::get<double>(value)}}; };
  k.get = [](const PressureSection& s) {
    return s.table.size() == 1 ? std::optional<Value>(s.table.front()[1]) : std::nullopt;
  };
  return k;
}

Key<PressureSection> pressure_table(Limits limits) {
  Key<PressureSection> k;
  k.spec = {.name = "table",
            .type = ValueType::rows,
            .unit = "h, MPa",
            .limits = std::move(limits),
            .choices = {},
            .meaning = "[[time, pressure], ...]: linear in between, constant before the first and after the last.",
            .source = "docs/physics.md 3",
            .default_text = "none",
            .condition = {},
            .response_section = {},
            .set = {},
            .get = {}};
  k.set = [](PressureSection& s, const Value& value) { s.table = std::get<Rows>(value); };
  k.get = [](const PressureSection& s) { return s.table.size() > 1 ? std::optional<Value>(s.table) : std::nullopt; };
  return k;
}

// ---- the table ------------------------------------------------------------------------------------

// clang-format off
std::vector<SectionSpec> make_schema() {
  using enum SectionKind;
  const Allowed any_text = one_of({});
  const Limits modulus = above(0).up_to(1e7, pascals);
  const Limits pressure = at_least(-10).up_to(10, pascals);
  const Limits softening = at_least(0);
  const Limits slope_mm = above(0).up_to(1e3, microns);
  const Limits place_mm = between(-1e3, 1e3);
  const Limits fraction = between(-1, 1);
  const char* response_growth = "response.growth";
  const char* response_anisotropy = "response.anisotropy";
  std::vector<SectionSpec> t;

  using Sc = SceneSection;
  t.push_back(section<Sc>("scene", required, "What is simulated, and for how long.", [](auto& s) { return &s.scene; }, {
    key(&Sc::name, "name", "-", any_text, "Name of the run: letters, digits, _ - and dot.", "-")
        .defaults_to("the file's name"),
    key(&Sc::dimension, "dimension", "-", between(2, 3), "2 (per mm of depth) or 3.", "paper 4.4"),
    key(&Sc::duration_h, "duration_h", "h", above(0).up_to(1e4, seconds), "Simulated time.", "Table 1: T").required(),
    key(&Sc::seed, "seed", "-", at_least(0), "Start of the random numbers (jitter, size_variation).", "-"),
    key(&Sc::allow_unstable, "allow_unstable", "-", any_number,
        "Run even where waves in the tissue grow by themselves.", "docs/physics.md 3"),
  }));

  using Ro = RootSection;
  t.push_back(section<Ro>("root", required, "The cells at the start: a capsule filled with a lattice, or a cell file.",
                          [](auto& s) { return &s.root; }, {
    key(&Ro::cells_file, "cells_file", "-", any_text, "Cells from microscopy (CSV in microns), relative to this file.",
        "MorphoGraphX export"),
    key(&Ro::tip_axis, "tip_axis", "-", one_of({"+x", "-x", "+y", "-y", "+z", "-z"}),
        "Direction of the tip in the cell file.", "-").only_with("cells_file"),
    key(&Ro::length_mm, "length_mm", "mm", above(0).up_to(1e3, microns), "From the base to the tip.", "paper 4.4")
        .required().only_without("cells_file"),
    key(&Ro::radius_mm, "radius_mm", "mm", above(0).up_to(20, microns), "Radius (2D: half the width).", "paper 4.4")
        .required().only_without("cells_file"),
    key(&Ro::cell_size_mm, "cell_size_mm", "mm", above(0).up_to(1, microns), "Spacing of the lattice.", "Table 1: l0")
        .required().only_without("cells_file"),
    key(&Ro::jitter, "jitter", "-", between(0, 0.5), "Random displacement of the centres, fraction of the spacing.",
        "docs/physics.md 5").only_without("cells_file"),
    key(&Ro::size_variation, "size_variation", "-", between(0, 0.95), "Cell volumes vary by a factor 1-v to 1+v.",
        "docs/physics.md 7").only_without("cells_file"),
    key(&Ro::curvature_per_mm, "curvature_per_mm", "1/mm", between(-1e3, 1e3),
        "Initial curvature of the axis, x-y plane.", "docs/physics.md 7").only_without("cells_file"),
    key(&Ro::base_obliquity_deg, "base_obliquity_deg", "deg", between(-80, 80), "Angle of the cut at the base.",
        "docs/physics.md 7").only_without("cells_file"),
    key(&Ro::cap, "cap", "-", any_number, "Round tip; false: cut straight.", "paper 4.4").only_without("cells_file"),
    key(&Ro::base, "base", "-", one_of({"clamped", "free"}), "How the base is held.", "paper 4.4"),
    key(&Ro::clamp_length_mm, "clamp_length_mm", "mm", at_least(0).up_to(1e3, microns),
        "Length held at the base; 0 = three cells.", "docs/physics.md 5").only_where("base", {"clamped"}),
  }));

  using Ti = TissueSection;
  t.push_back(section<Ti>("tissue", required, "Elastic law of the tissue.", [](auto& s) { return &s.tissue; }, {
    key(&Ti::law, "law", "-", one_of({"elastic_growth", "pressure_deviator"}),
        "elastic_growth: full stress, growth along the elastic strain; pressure_deviator: Eq. 1-4 to the letter.",
        "paper Eq. 1-4, docs/physics.md 3"),
    key(&Ti::E_axial_MPa, "E_axial_MPa", "MPa", modulus, "Axial Young modulus E_A.", "Table 1: 1020").required(),
    key(&Ti::nu_axial, "nu_axial", "-", inside(-1, 1), "Axial Poisson ratio nu_A.", "Table 1: 0.06"),
    key(&Ti::nu_radial, "nu_radial", "-", inside(-1, 1), "Radial Poisson ratio nu_R (3D).", "Table 1: 0.3"),
    key(&Ti::G_MPa, "G_MPa", "MPa", modulus, "Shear modulus between axis and radius.", "paper Eq. 4, docs/physics.md 3")
        .defaults_to("E_A/(2(1+nu_A))"),
    key(&Ti::rho0_ug_mm3, "rho0_ug_mm3", "ug/mm^3", above(0).up_to(1e6, {}), "Equilibrium density.", "Table 1: 1000"),
  }));

  using An = AnisotropySection;
  t.push_back(section<An>("tissue.anisotropy", optional,
                          "Radial modulus along the root: E_R = E_A + (E_H - E_A)(c_e + (1 - c_e)/"
                          "(1 + exp(-s_e (s - x_e)))); absent: E_R = E_A.",
                          [](auto& s) { return &s.tissue.anisotropy; }, {
    key(&An::E_radial_max_MPa, "E_radial_max_MPa", "MPa", modulus, "Largest radial modulus E_H.", "Table 1: 15000")
        .required().or_from_response(response_anisotropy),
    key(&An::x_e_mm, "x_e_mm", "mm", place_mm, "Distance from the tip of the transition.", "Eq. 6, Table 1")
        .required().or_from_response(response_anisotropy),
    key(&An::s_e_per_mm, "s_e_per_mm", "1/mm", at_least(0), "Slope of the transition.", "Eq. 6, Table 1")
        .required().or_from_response(response_anisotropy),
    key(&An::c_e, "c_e", "-", fraction, "Scale at the tip.", "Eq. 6, Table 1")
        .required().or_from_response(response_anisotropy),
  }));

  using Pr = PressureSection;
  t.push_back(section<Pr>("pressure", optional, "Pressure differential, uniform over the root.",
                          [](auto& s) { return &s.pressure; },
                          {constant_pressure(pressure), pressure_table(pressure)}));

  using Gr = GrowthSection;
  t.push_back(section<Gr>("growth", optional,
                          "Walls soften and yield: lambda = lambda0 ((1+c_g)/2 + (1-c_g)/2 (s-x_g)/s_g "
                          "exp(0.5 - (s-x_g)^2/(2 s_g^2))), never below 0.",
                          [](auto& s) { return &s.growth; }, {
    key(&Gr::lambda0_ug_mm3_h, "lambda0_ug_mm3_h", "ug/mm^3/h", softening,
        "Softening coefficient; measured roots need about a tenth of the printed values.", "Eq. 6, Table 1, docs/physics.md 4")
        .required().or_from_response(response_growth),
    key(&Gr::x_g_mm, "x_g_mm", "mm", place_mm, "Inflection of the bell; its peak lies at x_g + s_g.", "Eq. 6, Table 1")
        .required().or_from_response(response_growth),
    key(&Gr::s_g_mm, "s_g_mm", "mm", slope_mm, "Width of the bell.", "Eq. 6, Table 1")
        .required().or_from_response(response_growth),
    key(&Gr::c_g, "c_g", "-", fraction, "Scale: far from the tip lambda tends to (1+c_g)/2 lambda0.", "Eq. 6, Table 1")
        .required().or_from_response(response_growth),
    key(&Gr::mature_at_mm, "mature_at_mm", "mm", above(0).up_to(1e3, microns),
        "Growth ends at this distance from the tip; none: Eq. 6 to the letter.", "docs/physics.md 4"),
    key(&Gr::mature_width_mm, "mature_width_mm", "mm", above(0).up_to(1e3, microns), "Width of that end.", "docs/physics.md 4")
        .only_with("mature_at_mm"),
  }));

  using Di = DivisionSection;
  t.push_back(section<Di>("division", optional,
                          "A cell divides when its longest axis reaches l0 (c_d + s_d (s - x_d)^2).",
                          [](auto& s) { return &s.division; }, {
    key(&Di::l0_mm, "l0_mm", "mm", above(0).up_to(1, microns), "Reference cell size.", "Eq. 6, Table 1").required(),
    key(&Di::c_d, "c_d", "-", above(0), "Scale of the threshold.", "Eq. 6, Table 1"),
    key(&Di::s_d_per_mm2, "s_d_per_mm2", "1/mm^2", at_least(0), "How fast the threshold rises.", "Eq. 6, Table 1"),
    key(&Di::x_d_mm, "x_d_mm", "mm", place_mm, "Distance from the tip of the smallest threshold.", "Eq. 6, Table 1"),
    key(&Di::constant_beyond_mm, "constant_beyond_mm", "mm", at_least(0).up_to(1e3, microns),
        "The threshold stays constant beyond this distance from the tip.", "paper 2.3"),
  }));

  using Re = ResponseSection;
  t.push_back(section<Re>("response", optional,
                          "Parameters that follow the pressure differential, between their values at two pressures.",
                          [](auto& s) { return &s.response; }, {
    key(&Re::extrapolate, "extrapolate", "-", any_number,
        "Go on linearly outside the two pressures; false: hold.", "Eq. 7"),
  }));

  using Rg = ResponseSection::Growth;
  t.push_back(section<Rg>("response.growth", optional,
                          "Keys of [growth] as pairs: [value at the first pressure, value at the second].",
                          [](auto& s) { return s.response ? &s.response->growth : nullptr; }, {
    key(&Rg::p_MPa, "p_MPa", "MPa", pressure, "The two pressure differentials.", "Eq. 7, paper 2.4").required(),
    key(&Rg::lambda0_ug_mm3_h, "lambda0_ug_mm3_h", "ug/mm^3/h", softening, "As in [growth].", "Eq. 7, Table 1"),
    key(&Rg::x_g_mm, "x_g_mm", "mm", place_mm, "As in [growth].", "Eq. 7, Table 1"),
    key(&Rg::s_g_mm, "s_g_mm", "mm", slope_mm, "As in [growth].", "Eq. 7, Table 1"),
    key(&Rg::c_g, "c_g", "-", fraction, "As in [growth].", "Eq. 7, Table 1"),
  }));

  using Ra = ResponseSection::Anisotropy;
  t.push_back(section<Ra>("response.anisotropy", optional,
                          "Keys of [tissue.anisotropy] as pairs: [value at the first pressure, value at the second].",
                          [](auto& s) { return s.response ? &s.response->anisotropy : nullptr; }, {
    key(&Ra::p_MPa, "p_MPa", "MPa", pressure, "The two pressure differentials.", "Eq. 7, paper 2.4").required(),
    key(&Ra::E_radial_max_MPa, "E_radial_max_MPa", "MPa", modulus, "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
    key(&Ra::x_e_mm, "x_e_mm", "mm", place_mm, "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
    key(&Ra::s_e_per_mm, "s_e_per_mm", "1/mm", at_least(0), "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
    key(&Ra::c_e, "c_e", "-", fraction, "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
  }));

  using Nc = NonAffineControlSection;
  t.push_back(section<Nc>("non_affine_control", optional,
                          "Damps and resists pair motions that no velocity gradient can see.",
                          [](auto& s) { return &s.non_affine_control; }, {
    key(&Nc::damping, "damping", "-", at_least(0), "Damping alpha.", "docs/physics.md 5.4"),
    key(&Nc::stiffness, "stiffness", "-", at_least(0), "Elastic penalty, times E_A.", "docs/decisions/0009"),
  }));

  using Sl = SleepSection;
  t.push_back(section<Sl>("sleep", optional,
                          "Mature tissue that does not move is left out of the computation until something moves it.",
                          [](auto& s) { return &s.sleep; }, {
    key(&Sl::strain_rate_per_h, "strain_rate_per_h", "1/h", above(0),
        "Tissue that strains no faster, from the base on, falls asleep.", "docs/effects.md")
        .defaults_to("1e-4; with [soil] 5e-3"),
    key(&Sl::mean_over_h, "mean_over_h", "h", above(0),
        "Time over which that is averaged: grains push to and fro.", "docs/effects.md")
        .defaults_to("ten windows; with [soil] 0.1"),
    key(&Sl::stress_change, "stress_change", "-", above(0),
        "Change of axial stress beside the sleeping tissue, or of the soil's force on a cell's face, that wakes it, over "
        "the pressure differential.", "docs/effects.md")
        .defaults_to("0.05; with [soil] 0.3"),
  }));

  using Ob = ObstacleSection;
  t.push_back(section<Ob>("obstacle", repeated, "A rigid obstacle: penalty contact with Coulomb friction.",
                          [](auto& s) { return &s.obstacles; }, {
    key(&Ob::name, "name", "-", any_text, "For messages and outputs; unique.", "-").defaults_to("obstacle_1, ..."),
    key(&Ob::shape, "shape", "-", one_of({"plane", "box", "disc", "sphere"}), "disc in 2D only, sphere in 3D only.",
        "paper S4").required(),
    key(&Ob::position_mm, "position_mm", "mm", place_mm, "A point of the plane, or the centre.", "-").required(),
    key(&Ob::normal, "normal", "-", any_number, "Direction out of the plane, towards the root; this or angle_deg.", "-")
        .only_where("shape", {"plane"}).defaults_to("none"),
    key(&Ob::angle_deg, "angle_deg", "deg", between(-360, 360),
        "Turned about z. Plane: angle between plane and x axis; 90 faces the root, normal = (-sin, cos).", "-")
        .only_where("shape", {"plane", "box"}).defaults_to("box: 0.0")
        .written_when([](const Ob& o) { return o.shape != "plane"; }),  // a plane's angle has become its normal
    key(&Ob::half_size_mm, "half_size_mm", "mm", above(0).up_to(1e3, microns), "Half the box's sides.", "-")
        .required().only_where("shape", {"box"}),
    key(&Ob::radius_mm, "radius_mm", "mm", above(0).up_to(1e3, microns), "Radius.", "-")
        .required().only_where("shape", {"disc", "sphere"}),
    key(&Ob::friction, "friction", "-", at_least(0), "Coulomb coefficient.", "-"),
    key(&Ob::contact_modulus_MPa, "contact_modulus_MPa", "MPa", modulus, "Stiffness of the penalty.", "-")
        .defaults_to("E_axial_MPa"),
  }));

  using Pb = ProbeSection;
  t.push_back(section<Pb>("probe", repeated, "The tissue followed over time: at a cell, or in a bin along the root.",
                          [](auto& s) { return &s.probes; }, {
    key(&Pb::name, "name", "-", any_text, "For outputs; unique.", "-").defaults_to("probe_1, ..."),
    key(&Pb::position_mm, "position_mm", "mm", place_mm, "The cell nearest to it at the start; this or the bin.", "-"),
    key(&Pb::distance_to_tip_mm, "distance_to_tip_mm", "mm", at_least(0).up_to(1e3, microns),
        "Bin [from, to] along the root; this or the position.", "-"),
  }));

  using Nu = NumericsSection;
  t.push_back(section<Nu>("numerics", defaulted, "How it is computed. Keys that are left out follow from accuracy.",
                          [](auto& s) { return &s.numerics; }, {
    key(&Nu::accuracy, "accuracy", "-", one_of(preset_names()), "Preset for the keys that are left out.", "-"),
    key(&Nu::step_h, "step_h", "h", above(0).up_to(1, seconds), "Time step.", "docs/physics.md 5.5")
        .defaults_to("from accuracy"),
    key(&Nu::window_steps, "window_steps", "-", between(1, 1000),
        "Steps for which neighbours and gradients stay frozen.", "docs/physics.md 5.6").defaults_to("from accuracy"),
    key(&Nu::kernel, "kernel", "-", one_of({"cell", "isotropic"}),
        "cell: in the metric of each cell; isotropic: the paper's.", "docs/physics.md 5.1, paper 4.4"),
    key(&Nu::eta, "eta", "-", between(0.5, 5), "Kernel size over cell size (cell kernel).", "docs/physics.md 5.1")
        .defaults_to("from accuracy"),
    key(&Nu::H_bar, "H_bar", "-", above(0).up_to(20, {}), "Kernel size over cell size (isotropic kernel).",
        "Table 1: 2 to 8"),
    key(&Nu::gradient, "gradient", "-", one_of({"plain", "linear", "quadratic", "quadratic_at_surface"}),
        "Order to which the gradient is exact.", "docs/physics.md 5.2, 5.8").defaults_to("from accuracy"),
    key(&Nu::stepper, "stepper", "-", one_of({"symplectic", "predictor_corrector"}), "Time stepping.", "paper 4.4"),
    key(&Nu::inertia, "inertia", "-", one_of({"tensor", "scalar"}), "Inertia from the stability bound.", "docs/physics.md 5.5"),
    key(&Nu::inertia_compensation, "inertia_compensation", "-", any_number,
        "Cancel the leading inertia error of steady growth.", "docs/physics.md 5.9"),
    key(&Nu::mass_damping_per_h, "mass_damping_per_h", "1/h", at_least(0),
        "Damping that settles a root without growth.", "docs/physics.md 5.11").defaults_to("growth: 0, else 2 omega"),
    key(&Nu::midline_damping_per_h, "midline_damping_per_h", "1/h", at_least(0),
        "Damping of the midline's lateral motion, against hose flutter.", "docs/decisions/0003")
        .defaults_to("growth, no obstacle: 5"),
    key(&Nu::artificial_viscosity, "artificial_viscosity", "-", at_least(0), "Bulk pair viscosity.", "docs/physics.md 6"),
    key(&Nu::start, "start", "-", one_of({"equilibrium", "rest"}),
        "equilibrium: stress p and the closed form's velocity; rest: the paper's.", "docs/physics.md 5.9, paper 4.4"),
  }));

  using Ou = OutputSection;
  t.push_back(section<Ou>("output", required, "What is written, and when.", [](auto& s) { return &s.output; }, {
    key(&Ou::every_h, "every_h", "h", above(0).up_to(1e4, seconds), "Time between frames.", "-").required(),
    key(&Ou::checkpoint_every_h, "checkpoint_every_h", "h", above(0).up_to(1e4, seconds),
        "Time between checkpoints.", "-")
        .defaults_to("every_h"),
    key(&Ou::fields, "fields", "-", any_text, "Fields of the frames; empty: all.", "-"),
    key(&Ou::picture, "picture", "-", any_number, "Draw overview.png when the run ends.", "-"),
  }));

  using So = SoilSection;
  const auto soil_key = [](auto member, auto... rest) { return key(member_of<So>(member), std::move(rest)...); };
  t.push_back(section<So>("soil", optional, "Granular soil around the root, moved by YADE in a process of its own.",
                          [](auto& s) { return &s.soil; }, {
    soil_key(&So::soil_dimension, "dimension", "-", between(2, 3), "2: one layer of discs; 3: balls. The scene's.",
        "docs/soil.md").defaults_to("scene.dimension").written_when([](const So&) { return false; }),
    soil_key(&So::box_from_mm, "box_from_mm", "mm", place_mm, "Corner of the box; the root enters through x = from.",
        "docs/soil.md").required(),
    soil_key(&So::box_to_mm, "box_to_mm", "mm", place_mm, "Opposite corner; the root grows towards x = to.", "docs/soil.md")
        .required(),
    soil_key(&So::walls, "walls", "-", one_of({"rigid", "servo", "mixed"}),
        "rigid: all stand still; servo: all keep the pressure; mixed: servo, but the one at x = to stands still.",
        "docs/soil.md"),
    soil_key(&So::confining_pressure_MPa, "confining_pressure_MPa", "MPa", at_least(0).up_to(10, pascals),
        "Pressure of packing and of servo walls.", "docs/soil.md").required(),
    soil_key(&So::d_range_mm, "d_range_mm", "mm", above(0).up_to(1e2, microns),
        "Smallest and largest grain diameter, evenly spread; this or d_mean_mm.", "docs/soil.md"),
    soil_key(&So::d_mean_given_mm, "d_mean_mm", "mm", above(0).up_to(1e2, microns), "Mean grain diameter; this or d_range_mm.",
        "docs/soil.md"),
    soil_key(&So::d_spread_given, "d_spread", "-", Limits{.low = 0, .high = 1, .high_open = true, .above_remedy = {}},
        "Diameters lie within d_mean (1 - spread) and d_mean (1 + spread).", "docs/soil.md")
        .only_with("d_mean_mm").defaults_to("0.2"),
    soil_key(&So::grains_file, "grains_file", "-", any_text,
        "Grains from a CSV (x_mm, y_mm, z_mm, radius_mm) instead of packing.", "docs/soil.md"),
    soil_key(&So::contact_law, "contact_law", "-", one_of({"linear", "hertz_mindlin", "cohesive"}), "Law between bodies that touch.",
        "docs/soil.md"),
    soil_key(&So::E_MPa, "E_MPa", "MPa", modulus, "Stiffness of the grains: 250 times the stress on the tip keeps overlaps small.",
        "docs/soil.md").required(),
    soil_key(&So::poisson, "poisson", "-", Limits{.low = 0, .high = 0.5, .low_open = true, .above_remedy = {}},
        "linear, cohesive: tangential over normal stiffness; hertz_mindlin: Poisson's ratio.", "docs/soil.md"),
    soil_key(&So::friction_deg, "friction_deg", "deg", Limits{.low = 0, .high = 80, .above_remedy = "this is an angle, not a coefficient"},
        "Angle of friction between grains.", "docs/soil.md"),
    soil_key(&So::root_friction_deg, "root_friction_deg", "deg",
        Limits{.low = 0, .high = 80, .above_remedy = "this is an angle, not a coefficient"},
        "Between root and grains; the smaller of the two angles holds.", "docs/soil.md"),
    soil_key(&So::rolling, "rolling", "-", between(0, 5), "Rolling resistance: moment over normal force times radius.",
        "docs/soil.md"),
    soil_key(&So::cohesion_MPa, "cohesion_MPa", "MPa", at_least(0).up_to(1e3, pascals),
        "Strength of bonds between grains that touch at the start.", "docs/soil.md").only_where("contact_law", {"cohesive"}),
    soil_key(&So::density_N_h2_mm4, "density_N_h2_mm4", "N h^2/mm^4", above(0),
        "Of the grains, numerical; absent: from inertial_number_max and the root's expected speed.", "docs/soil.md")
        .defaults_to("from inertial_number_max"),
    soil_key(&So::inertial_number_max, "inertial_number_max", "-", above(0).up_to(1, {}),
        "Inertial number at the root's expected speed; soil is quasi-static up to 0.01.", "docs/soil.md")
        .only_without("density_N_h2_mm4"),
    soil_key(&So::porosity, "porosity", "-", inside(0, 1), "Wanted; absent: what compaction_friction_deg gives.", "docs/soil.md"),
    soil_key(&So::compaction_friction_deg, "compaction_friction_deg", "deg", between(0, 80),
        "Angle of friction while packing: small packs densely.", "docs/soil.md").only_without("porosity"),
    soil_key(&So::seed, "seed", "-", at_least(1).up_to(2e9, {}), "Of the packing.", "docs/soil.md"),
    soil_key(&So::step_safety, "step_safety", "-", above(0).up_to(1, {}), "Substep over the P-wave step of the smallest grain.",
        "docs/soil.md"),
    soil_key(&So::damping, "damping", "-", between(0, 0.95), "YADE's local damping of the grains.", "docs/soil.md"),
    soil_key(&So::threads, "threads", "-", between(1, 256), "Of YADE; with more than one no two runs are bit-identical.",
        "docs/soil.md"),
  }));

  using Sb = SoilObstacle;
  t.push_back(section<Sb>("soil.obstacle", repeated,
                          "A rigid body inside the soil, met by grains and root; a gap is a place without grains.",
                          [](auto& s) { return s.soil ? &s.soil->obstacles : nullptr; }, {
    key(&Sb::name, "name", "-", any_text, "For messages; unique.", "-").defaults_to("soil.obstacle_1, ..."),
    key(&Sb::shape, "shape", "-", one_of({"box", "plate", "stone", "clump", "gap"}),
        "stone: a ball; clump: three balls that hold together.", "docs/soil.md").required(),
    key(&Sb::position_mm, "position_mm", "mm", place_mm, "Centre.", "-").required(),
    key(&Sb::half_size_mm, "half_size_mm", "mm", above(0).up_to(1e3, microns), "Half the sides.", "-")
        .required().only_where("shape", {"box", "gap"}),
    key(&Sb::length_mm, "length_mm", "mm", above(0).up_to(1e3, microns), "Side of the plate.", "-")
        .required().only_where("shape", {"plate"}),
    key(&Sb::thickness_mm, "thickness_mm", "mm", above(0).up_to(1e3, microns), "Of the plate.", "-")
        .only_where("shape", {"plate"}),
    key(&Sb::angle_deg, "angle_deg", "deg", between(-360, 360), "Turned about z.", "-")
        .only_where("shape", {"box", "plate", "gap", "clump"}),
    key(&Sb::radius_mm, "radius_mm", "mm", above(0).up_to(1e3, microns), "Of the stone, or of the clump as a whole.", "-")
        .required().only_where("shape", {"stone", "clump"}),
    key(&Sb::movable, "movable", "-", any_number, "Pushed aside like a grain.", "-").only_where("shape", {"stone", "clump"}),
  }));

  using Sk = SoilContactSection;
  t.push_back(section<Sk>("soil.contact", optional, "How root and soil exchange motion and forces.",
                          [](auto& s) { return s.soil ? &s.soil_contact : nullptr; }, {
    key(&Sk::interval_h, "interval_h", "h", above(0).up_to(1, seconds),
        "Between two exchanges, rounded to whole windows: the accuracy knob of the coupling.", "docs/soil.md"),
    key(&Sk::marker_radius_mm, "marker_radius_mm", "mm", above(0).up_to(10, microns), "Of the balls that are the root's surface.",
        "docs/soil.md").defaults_to("one cell"),
    key(&Sk::marker_spacing, "marker_spacing", "-", Limits{.low = 0.1, .high = 1, .above_remedy = "markers must be closer than their radius"},
        "Between markers, of their radius.", "docs/soil.md"),
    key(&Sk::map_width_cells, "map_width_cells", "-", between(1, 3), "Reach of the weights between cells and markers, half of it.",
        "docs/soil.md"),
    key(&Sk::ramp_h, "ramp_h", "h", at_least(0).up_to(1e3, seconds), "Forces rise from nothing over this time.", "docs/soil.md"),
    key(&Sk::stiffness_predictor, "stiffness_predictor", "-", any_number,
        "Within an interval forces follow the contact stiffness; for rigid walls only.", "docs/soil.md"),
    key(&Sk::under_relaxation, "under_relaxation", "-", any_number, "Aitken's, for a stiff, tightly held root.", "docs/soil.md"),
    key(&Sk::tip_length_mm, "tip_length_mm", "mm", above(0).up_to(1e3, microns), "What counts as tip in tip forces.", "docs/soil.md")
        .defaults_to("a root's diameter"),
  }));

  using Pn = PenetrometerSection;
  t.push_back(section<Pn>("penetrometer", optional, "A probe pushed into [soil] by rootsoil penetrometer; a run ignores it.",
                          [](auto& s) { return &s.penetrometer; }, {
    key(&Pn::diameter_mm, "diameter_mm", "mm", above(0).up_to(1e2, microns), "Of the shaft.", "docs/soil.md").required(),
    key(&Pn::cone_angle_deg, "cone_angle_deg", "deg", between(10, 180), "Full angle of the cone; 180: a round tip.",
        "docs/soil.md"),
    key(&Pn::rate_mm_h, "rate_mm_h", "mm/h", above(0).up_to(1e6, {}), "Of penetration; the grains' density follows from it.",
        "docs/soil.md").required(),
    key(&Pn::depth_mm, "depth_mm", "mm", above(0).up_to(1e3, microns), "At the end, from the wall x = from.", "docs/soil.md")
        .required(),
    key(&Pn::average_from_mm, "average_from_mm", "mm", at_least(0).up_to(1e3, microns), "Depth from which Q is averaged.",
        "docs/soil.md").defaults_to("depth_mm - 1 mm"),
    key(&Pn::friction_deg, "friction_deg", "deg", between(0, 80), "Between probe and grains.", "docs/soil.md")
        .defaults_to("soil.root_friction_deg").written_when([](const Pn& s) { return s.friction_deg >= 0.0; }),
    key(&Pn::seeds, "seeds", "-", between(1, 100), "Samples, with seeds from soil.seed upwards.", "docs/soil.md"),
    key(&Pn::interval_h, "interval_h", "h", above(0).up_to(1e3, seconds), "Between two readings of Q.", "docs/soil.md")
        .defaults_to("0.01 diameter/rate"),
    key(&Pn::turgor_MPa, "turgor_MPa", "MPa", above(0).up_to(10, pascals), "For the paper's p = turgor - Q/4.", "paper 2.1"),
  }));
  return t;
}

// clang-format on

// ---- text -----------------------------------------------------------------------------------------

std::string number_text(double number) {
  std::string text = fmt::format("{}", number);  // the shortest that reads back as the same number
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

std::string toml_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

template <class Range, class ToText>
std::string list_text(const Range& range, ToText to_text) {
  std::string out;
  for (const auto& element : range) out += (out.empty() ? "" : ", ") + to_text(element);
  return "[" + out + "]";
}

std::string type_text(ValueType type, int dimension) {
  switch (type) {
    case ValueType::boolean:
      return "true or false";
    case ValueType::integer:
      return "a whole number";
    case ValueType::number:
      return "a number";
    case ValueType::text:
      return "a text";
    case ValueType::pair:
      return "two numbers";
    case ValueType::vector:
      return dimension == 0 ? "a number per dimension" : fmt::format("{} numbers", dimension);
    case ValueType::texts:
      return "a list of texts";
    case ValueType::rows:
      return "a list of pairs of numbers";
  }
  return {};
}

std::string condition_text(const Condition& condition) {
  if (condition.absent) return "only without " + condition.key;
  if (condition.values.empty()) return "only with " + condition.key;
  return fmt::format("only where {} is {}", condition.key, fmt::join(condition.values, " or "));
}

std::string wrapped(std::string_view text, std::size_t indent) {
  constexpr std::size_t columns = 100;
  std::string out;
  std::size_t column = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (column == 0 || column + 1 + word.size() > columns) {
      out += (out.empty() ? "" : "\n") + std::string(indent, ' ');
      column = indent;
    } else {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
    begin = end + 1;
  }
  return out + "\n";
}

std::string kind_text(SectionKind kind) {
  switch (kind) {
    case SectionKind::required:
      return "required";
    case SectionKind::defaulted:
      return "every key has a default";
    case SectionKind::optional:
      return "absent: the effect is absent";
    case SectionKind::repeated:
      return "as many as wanted";
  }
  return {};
}

std::string describe_section(const SectionSpec& s) {
  std::string out = fmt::format("{}  ({})\n", section_header(s), kind_text(s.kind));
  out += wrapped(s.meaning, 2);
  std::size_t name_width = 0, type_width = 0, unit_width = 0;
  for (const KeySpec& k : s.keys) {
    name_width = std::max(name_width, k.name.size());
    type_width = std::max(type_width, type_text(k.type, 0).size());
    unit_width = std::max(unit_width, k.unit.size());
  }
  for (const KeySpec& k : s.keys) {
    out += fmt::format("\n  {:{}}  {:{}}  {:{}}  {}\n", k.name, name_width, type_text(k.type, 0), type_width, k.unit,
                       unit_width, k.required ? "required" : "default: " + k.default_text);
    const std::string condition = k.condition ? condition_text(*k.condition) : std::string();
    if (k.limits.bounded() || !k.choices.empty()) {
      const std::string allowed = k.choices.empty() ? k.limits.text() : fmt::format("{}", fmt::join(k.choices, ", "));
      out += wrapped(fmt::format("allowed: {}{}{}", allowed, condition.empty() ? "" : "; ", condition), 6);
    } else if (!condition.empty()) {
      out += wrapped(condition, 6);
    }
    if (!k.response_section.empty()) out += wrapped(fmt::format("here or in [{}]", k.response_section), 6);
    out += wrapped(k.source == "-" ? k.meaning : fmt::format("{} ({})", k.meaning, k.source), 6);
  }
  return out;
}

}  // namespace

// ---- public ---------------------------------------------------------------------------------------

bool Limits::contains(double number) const {
  return (low_open ? number > low : number >= low) && (high_open ? number < high : number <= high);
}

bool Limits::bounded() const { return std::isfinite(low) || std::isfinite(high); }

std::string Limits::text() const {
  std::string out;
  if (std::isfinite(low)) out = fmt::format("{} {}", low_open ? "above" : "at least", low);
  if (std::isfinite(high))
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", high_open ? "below" : "at most", high);
  return out;
}

Limits Limits::up_to(double highest, std::string remedy) const {
  Limits limits = *this;
  limits.high = highest;
  limits.above_remedy = std::move(remedy);
  return limits;
}

const KeySpec* SectionSpec::find(std::string_view key) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const KeySpec& k) { return k.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

const std::vector<SectionSpec>& schema() {
  static const std::vector<SectionSpec> table = make_schema();
  return table;
}

const SectionSpec* find_section(std::string_view name) {
  const std::vector<SectionSpec>& t = schema();
  const auto found = std::find_if(t.begin(), t.end(), [&](const SectionSpec& s) { return s.name == name; });
  return found == t.end() ? nullptr : &*found;
}

bool applies(const SectionSpec& section, const KeySpec& key, const Scene& scene, std::size_t index) {
  if (!key.condition) return true;
  const KeySpec* other = section.find(key.condition->key);
  ROOTSOIL_ASSERT(other != nullptr);
  const std::optional<Value> value = other->get(scene, index);
  if (key.condition->absent) return !value;
  if (key.condition->values.empty()) return value.has_value();
  const auto& words = key.condition->values;
  return value && std::find(words.begin(), words.end(), std::get<std::string>(*value)) != words.end();
}

bool supplied_by_response(const KeySpec& key, const Scene& scene) {
  if (key.response_section.empty()) return false;
  const SectionSpec& section = *find_section(key.response_section);
  return section.count(scene) > 0 && section.find(key.name)->get(scene, 0).has_value();
}

std::string key_path(const SectionSpec& section, std::size_t index, std::string_view key) {
  std::string path = section.name;
  if (section.kind == SectionKind::repeated) path += fmt::format("[{}]", index + 1);
  return key.empty() ? path : fmt::format("{}.{}", path, key);
}

std::string section_header(const SectionSpec& section) {
  return section.kind == SectionKind::repeated ? fmt::format("[[{}]]", section.name)
                                               : fmt::format("[{}]", section.name);
}

std::string toml_text(const Value& value) {
  struct {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
    std::string operator()(double v) const { return number_text(v); }
    std::string operator()(const std::string& v) const { return toml_quoted(v); }
    std::string operator()(const Numbers& v) const { return list_text(v, number_text); }
    std::string operator()(const Texts& v) const { return list_text(v, toml_quoted); }
    std::string operator()(const Rows& v) const {
      return list_text(v, [](const std::array<double, 2>& row) { return list_text(row, number_text); });
    }
  } to_text;
  return std::visit(to_text, value);
}

std::string allowed_text(const KeySpec& key, int dimension) {
  if (!key.choices.empty()) return fmt::format("one of {}", fmt::join(key.choices, ", "));
  std::string text = type_text(key.type, dimension);
  const bool single = key.type == ValueType::number || key.type == ValueType::integer;
  if (key.limits.bounded()) text += (single ? " " : ", each ") + key.limits.text();
  return text;
}

std::string describe(const std::optional<std::string>& section) {
  if (section) {
    if (const SectionSpec* found = find_section(*section)) return describe_section(*found);
    std::vector<std::string> names;
    for (const SectionSpec& s : schema()) names.push_back(s.name);
    throw InputError({.file = {},
                      .line = 0,
                      .key = {},
                      .what = "there is no such section",
                      .given = *section,
                      .allowed = fmt::format("{}", fmt::join(names, ", ")),
                      .remedy = fmt::format("did you mean {}?", nearest(*section, names))});
  }
  std::string out;
  for (const SectionSpec& s : schema()) out += (out.empty() ? "" : "\n") + describe_section(s);
  return out;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  // optimal string alignment; the word is cut because no key is that long and the cost is quadratic
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      now[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t changed = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
        now[j] = std::min({changed, last[j] + 1, now[j - 1] + 1});
        const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
        if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
      }
      std::swap(before, last);
      std::swap(last, now);
    }
    return last[b.size()];
  };
  std::string best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : candidates) {
    const std::size_t d = distance(word.substr(0, 64), candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace rootsoil
