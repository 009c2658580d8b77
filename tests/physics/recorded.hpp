// SPDX-License-Identifier: MIT
// Errors that tests measure, against those that were measured before: recorded_errors.csv. A bound of 2 % where 0.05 %
// is measured lets an error grow forty-fold before anyone notices.
#pragma once

#include <string>

namespace rootsoil::physics {

/// Prints a measured number and keeps it in the test's report.
void record(const std::string& name, double value);

/// An error, of either sign, of the test that runs: at most twice the recorded one. Less than a quarter of it is a
/// failure as well: the record is then to be renewed, so that it stays a bound.
///
/// $ROOTSOIL_RECORD=1 writes instead of comparing. Programs that do so run one after another:
///   for t in physics physics_slow soil_contact soil_buckling soil_run; do ROOTSOIL_RECORD=1 build/release/test_$t;
///   done
/// \param quantity unique in the test, without commas
/// \param noise below this nothing is asked: an error so small changes with the processor's vector width, by way of the
/// order of sums and what grows from it
void expect_within_record(const std::string& quantity, double error, double noise = 1e-4);

}  // namespace rootsoil::physics
