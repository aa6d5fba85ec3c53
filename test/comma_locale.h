/** \file
 * A locale that writes numbers otherwise. */
#pragma once

#include <clocale>
#include <cstdlib>
#include <iostream>
#include <locale>
#include <string>

namespace pcl_surflet {
namespace test {

/** \brief Numbers as in Germany, 1.234,5, while it lives: for the C++ streams made up, for the C
 * library real, as made by the build where Debian's package locales is installed. */
class CommaLocale {
  struct Comma : std::numpunct<char> {
    char
    do_decimal_point() const override
    {
      return ',';
    }
    char
    do_thousands_sep() const override
    {
      return '.';
    }
    std::string
    do_grouping() const override
    {
      return "\3";
    }
  };

public:
  CommaLocale() : before_(std::locale::global(std::locale(std::locale(), new Comma)))
  {
    ::setenv("LOCPATH", PCL_SURFLET_TEST_LOCALES, 1);
    if (!std::setlocale(LC_ALL, "de_DE.UTF-8"))
      std::cerr << "Note: there is no locale de_DE.UTF-8: tested with C++ streams only\n";
  }
  ~CommaLocale()
  {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

private:
  std::locale before_;
};

} // namespace test
} // namespace pcl_surflet
