#include "experiment/plots.h"

#include "app_common.h"
#include "experiment/output.h"

namespace pcl_surflet {
namespace apps {
namespace {

std::string
dataOf(const std::vector<Panel>& panels)
{
  std::string out;
  for (const auto& panel : panels)
    for (const auto& curve : panel.curves) {
      out += "# " + panel.title + ": " + curve.title + "\n";
      for (const auto& p : curve.points)
        out += formatted("%.5g %.5g %.5g %.5g\n", p.x, 100 * p.rate, 100 * p.low, 100 * p.high);
      out += "\n\n"; // gnuplot's separation of blocks
    }
  return out;
}

/** \brief Small plots, many in a picture, do without intervals and keys. */
bool
isSmall(std::size_t panels)
{
  return panels > 6;
}

std::string
plotCommand(const std::string& base, const Panel& panel, std::size_t first_block, bool small)
{
  std::vector<std::string> bands, lines;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const std::string block = formatted("'%s.dat' index %zu using ", base.c_str(), first_block + c);
    constexpr std::size_t kColours = 8; // gnuplot's; curves that share one differ by dashes
    const std::string colour = " lc " + std::to_string(c + 1);
    const std::string dashes = c < kColours ? "" : " dt 2";
    if (!small)
      bands.push_back(block + "1:3:4 with filledcurves fs transparent solid 0.15 noborder" +
                      colour + " notitle");
    lines.push_back(block + "1:2 with lines lw 1.5" + colour + dashes +
                    (small ? " notitle" : " title '" + panel.curves[c].title + "'"));
  }
  std::string out; // all lines above all bands
  for (const auto* parts : {&bands, &lines})
    for (const auto& part : *parts)
      out += (out.empty() ? "plot " : ", \\\n     ") + part;
  return out + "\n";
}

std::string
panelCommands(const std::string& base, const Panel& panel, std::size_t first_block, bool small)
{
  std::string out = "unset label\nset title \"" + panel.title + "\" noenhanced\nset xlabel \"" +
                    panel.x_label + "\"\n";
  if (!small)
    out += "set ylabel '" + panel.y_label + "'\n";
  for (const auto& s : panel.statements)
    out +=
        formatted("set label \"%s\" at %g,%g front point pt 6 ps 0.8 offset 0.6,-0.6 font ',9'\n",
                  s.text.c_str(), s.x, s.percent);
  return out + plotCommand(base, panel, first_block, small);
}

std::string
draw(const std::string& directory, const std::string& base, const std::string& picture,
     const std::string& data, const std::string& script)
{
  writeFile(directory + "/" + base + ".dat", data);
  writeFile(directory + "/" + base + ".gnuplot",
            "# Run in this folder: gnuplot " + base + ".gnuplot\n" + script);
  return drawByGnuplot(directory, base + ".gnuplot", picture);
}

/** \brief Rows of a grid that holds \p count things in \p columns. */
std::size_t
rowsFor(std::size_t count, std::size_t columns)
{
  return (count + columns - 1) / columns;
}

} // namespace

std::string
drawPanels(const std::string& directory, const std::string& base, const std::vector<Panel>& panels,
           std::size_t columns)
{
  const bool small = isSmall(panels.size());
  const std::size_t rows = rowsFor(panels.size(), columns);
  const std::size_t width = small ? 200 : (columns == 1 ? 720 : 400), height = small ? 150 : 380;
  const std::string terminal = small ? "pngcairo" : "svg"; // the frames alone take 300 kB of SVG
  const std::string picture = base + (small ? ".png" : ".svg");
  std::string script =
      formatted("set terminal %s size %zu,%zu background rgb 'white' font 'sans,%d'\n",
                terminal.c_str(), columns * width, rows * height, small ? 8 : 11) +
      outputStatements(picture) +
      formatted("set multiplot layout %zu,%zu\nset yrange [0:105]\nset grid lc rgb '#dddddd'\n"
                "set key outside bottom center horizontal\nset ytics 20\n",
                rows, columns);
  std::size_t block = 0;
  for (const auto& panel : panels) {
    script += panelCommands(base, panel, block, small);
    block += panel.curves.size();
  }
  return draw(directory, base, picture, dataOf(panels), script + "unset multiplot\n");
}

std::string
drawConfusions(const std::string& directory, const std::string& base,
               const std::vector<ConfusionPicture>& pictures, std::size_t columns)
{
  const std::size_t rows = rowsFor(pictures.size(), columns);
  std::string data;
  const std::string picture = base + ".png";
  std::string script =
      formatted("set terminal pngcairo size %zu,%zu font 'sans,11'\n", columns * 300, rows * 320) +
      outputStatements(picture) +
      formatted("set multiplot layout %zu,%zu\nset palette gray\nset cbrange [0:1]\n"
                "unset colorbox\nunset tics\nset size square\nset xlabel 'test objects'\n"
                "set ylabel 'trained objects'\n",
                rows, columns);
  for (std::size_t p = 0; p < pictures.size(); ++p) {
    const auto& rates = pictures[p].rates;
    for (std::size_t answer = 0; answer < rates.size(); ++answer) {
      for (std::size_t object = 0; object < rates.size(); ++object)
        data += formatted("%.4g ", rates[object][answer]);
      data += "\n";
    }
    data += "\n\n";
    script += "set title \"" + pictures[p].title + "\"\n" +
              formatted("set xrange [-0.5:%zu.5]\nset yrange [%zu.5:-0.5]\n", rates.size() - 1,
                        rates.size() - 1) +
              formatted("plot '%s.dat' index %zu matrix with image notitle\n", base.c_str(), p);
  }
  return draw(directory, base, picture, data, script + "unset multiplot\n");
}

} // namespace apps
} // namespace pcl_surflet
