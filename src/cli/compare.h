#pragma once

#include <CLI/CLI.hpp>

/// Adds `compare A B [--json] [--diff FILE]`. Its callback runs the command; errors leave it as InputError and
/// RenderError.
CLI::App* register_compare(CLI::App& app);
