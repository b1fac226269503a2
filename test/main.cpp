// Catch2's main function, compiled once for all tests that link it.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
