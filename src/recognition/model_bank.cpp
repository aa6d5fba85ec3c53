#include "pcl_surflet/recognition/model_bank.h"

#include <cstdio>
#include <locale>
#include <numeric>
#include <sstream>

namespace pcl_surflet {
namespace {

/** \brief Shortest text of a number as users write it, alike in every locale. */
std::string
plain(double value)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << value;
  return out.str();
}

/** \brief Reads one line; complains with its number. */
class LineReader {
public:
  LineReader(const std::string& line, std::size_t number)
      : words_(line.substr(0, line.find('#'))), number_(number)
  {
    words_.imbue(std::locale::classic());
  }

  /** \brief Adds what the line says to \p bank. */
  void
  addTo(ModelBank& bank)
  {
    std::string word;
    if (!(words_ >> word))
      return; // empty
    if (word == "normals") {
      bank.normal_radius = number("normals", 1.5, 100, "a radius in point spacings, as in 3");
      if (words_ >> word)
        refuse("'" + word + "' after the radius; a line 'normals' says nothing else");
      return;
    }
    BankCondition condition;
    do
      take(word, condition);
    while (words_ >> word);
    if (condition.noise == 0 && condition.visible == 1 && !condition.view)
      refuse("the condition changes nothing; the clean and complete member is always there, so "
             "remove the line or give noise, visible or view");
    bank.conditions.push_back(condition);
  }

private:
  void
  take(const std::string& word, BankCondition& c)
  {
    if (word == "noise")
      c.noise = number("noise", 0, 50, "percent of the diameter, as in 1") / 100;
    else if (word == "visible")
      c.visible = number("visible", 1, 100, "percent of the surface, as in 40") / 100;
    else if (word == "members")
      c.members = whole("members", BankCondition::kMostMembers);
    else if (word == "view")
      c.view = true;
    else
      refuse("'" + word + "' is none of noise, visible, view, members, normals");
  }

  double
  number(const char* what, double low, double high, const char* remedy)
  {
    std::string word;
    words_ >> word;
    std::istringstream in(word);
    in.imbue(std::locale::classic());
    double value = 0;
    if (!(in >> value) || in.peek() != EOF || !(value >= low && value <= high))
      refuse(std::string("'") + what + "' needs a number from " + plain(low) + " to " +
             plain(high) + (word.empty() ? "" : ", not '" + word + "'") + ": " + remedy);
    return value;
  }

  unsigned
  whole(const char* what, unsigned high)
  {
    const double value = number(what, 1, high, "how many histograms keep the condition, as in 6");
    if (value != static_cast<unsigned>(value))
      refuse(std::string("'") + what + "' needs a whole number, not " + plain(value));
    return static_cast<unsigned>(value);
  }

  [[noreturn]] void
  refuse(const std::string& why) const
  {
    throw ModelBankError("line " + std::to_string(number_) + " of the bank: " + why);
  }

  std::istringstream words_;
  std::size_t number_;
};

} // namespace

ModelBankError::~ModelBankError() = default;

std::string
BankCondition::name(std::size_t member, std::size_t of) const
{
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (view)
    add("view");
  if (noise > 0)
    add("noise " + plain(100 * noise) + " %");
  if (visible < 1)
    add("visible " + plain(100 * visible) + " %");
  if (of > 1)
    text += " (" + std::to_string(member + 1) + " of " + std::to_string(of) + ")";
  return text;
}

ModelBank
ModelBank::standard()
{
  return parse("noise 1\n"
               "noise 2\n"
               "noise 4\n"
               "visible 65 members 4\n"
               "visible 40 members 6\n"
               "visible 25 members 6\n"
               "view noise 0.3 members 6\n"
               "noise 4 visible 50 members 3\n");
}

ModelBank
ModelBank::none()
{
  return {};
}

ModelBank
ModelBank::parse(const std::string& text)
{
  ModelBank bank;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number)
    LineReader(line, number).addTo(bank);
  return bank;
}

std::string
ModelBank::toText() const
{
  std::string text = "normals " + plain(normal_radius) + "\n";
  for (const auto& c : conditions) {
    text += c.view ? "view" : "";
    if (c.noise > 0)
      text += std::string(c.view ? " " : "") + "noise " + plain(100 * c.noise);
    if (c.visible < 1)
      text += std::string(c.view || c.noise > 0 ? " " : "") + "visible " + plain(100 * c.visible);
    text += " members " + std::to_string(c.members) + "\n";
  }
  return text;
}

unsigned
ModelBank::members() const
{
  return std::accumulate(conditions.begin(), conditions.end(), 1u,
                         [](unsigned sum, const auto& c) { return sum + c.members; });
}

} // namespace pcl_surflet
