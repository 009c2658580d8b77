// SPDX-License-Identifier: MIT
// Growth, division, and how both respond to the pressure.
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil::sections {

namespace {

const Limits softening = at_least(0);
const Limits slope_mm = above(0).up_to(1e3, microns);

}  // namespace

// clang-format off
SectionSpec growth_section() {
  using Gr = GrowthSection;
  return section<Gr>("growth", optional,
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
  });
}

SectionSpec division_section() {
  using Di = DivisionSection;
  return section<Di>("division", optional,
                     "A cell divides when its longest axis reaches l0 (c_d + s_d (s - x_d)^2).",
                     [](auto& s) { return &s.division; }, {
    key(&Di::l0_mm, "l0_mm", "mm", above(0).up_to(1, microns), "Reference cell size.", "Eq. 6, Table 1").required(),
    key(&Di::c_d, "c_d", "-", above(0), "Scale of the threshold.", "Eq. 6, Table 1"),
    key(&Di::s_d_per_mm2, "s_d_per_mm2", "1/mm^2", at_least(0), "How fast the threshold rises.", "Eq. 6, Table 1"),
    key(&Di::x_d_mm, "x_d_mm", "mm", place_mm, "Distance from the tip of the smallest threshold.", "Eq. 6, Table 1"),
    key(&Di::constant_beyond_mm, "constant_beyond_mm", "mm", at_least(0).up_to(1e3, microns),
        "The threshold stays constant beyond this distance from the tip.", "paper 2.3"),
  });
}

SectionSpec response_section() {
  using Re = ResponseSection;
  return section<Re>("response", optional,
                     "Parameters that follow the pressure differential, between their values at two pressures.",
                     [](auto& s) { return &s.response; }, {
    key(&Re::extrapolate, "extrapolate", "-", any_number,
        "Go on linearly outside the two pressures; false: hold.", "Eq. 7"),
  });
}

SectionSpec response_growth_section() {
  using Rg = ResponseSection::Growth;
  return section<Rg>("response.growth", optional,
                     "Keys of [growth] as pairs: [value at the first pressure, value at the second].",
                     [](auto& s) { return s.response ? &s.response->growth : nullptr; }, {
    key(&Rg::p_MPa, "p_MPa", "MPa", pressure, "The two pressure differentials.", "Eq. 7, paper 2.4").required(),
    key(&Rg::lambda0_ug_mm3_h, "lambda0_ug_mm3_h", "ug/mm^3/h", softening, "As in [growth].", "Eq. 7, Table 1"),
    key(&Rg::x_g_mm, "x_g_mm", "mm", place_mm, "As in [growth].", "Eq. 7, Table 1"),
    key(&Rg::s_g_mm, "s_g_mm", "mm", slope_mm, "As in [growth].", "Eq. 7, Table 1"),
    key(&Rg::c_g, "c_g", "-", fraction, "As in [growth].", "Eq. 7, Table 1"),
  });
}

SectionSpec response_anisotropy_section() {
  using Ra = ResponseSection::Anisotropy;
  return section<Ra>("response.anisotropy", optional,
                     "Keys of [tissue.anisotropy] as pairs: [value at the first pressure, value at the second].",
                     [](auto& s) { return s.response ? &s.response->anisotropy : nullptr; }, {
    key(&Ra::p_MPa, "p_MPa", "MPa", pressure, "The two pressure differentials.", "Eq. 7, paper 2.4").required(),
    key(&Ra::E_radial_max_MPa, "E_radial_max_MPa", "MPa", modulus, "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
    key(&Ra::x_e_mm, "x_e_mm", "mm", place_mm, "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
    key(&Ra::s_e_per_mm, "s_e_per_mm", "1/mm", at_least(0), "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
    key(&Ra::c_e, "c_e", "-", fraction, "As in [tissue.anisotropy].", "Eq. 7, Table 1"),
  });
}
// clang-format on

}  // namespace rootsoil::sections
