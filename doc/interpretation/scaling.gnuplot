# Run where scaling.csv is (see scripts/evaluate_scenes.sh): gnuplot scaling.gnuplot
set terminal svg size 900,760 background rgb 'white'
set output 'scaling.svg'
set grid
set xrange [0:10.5]
set yrange [0:*]
set key outside bottom center horizontal
methods = 'dissertation explanation classic_vfh'
colours = '#1f5fa8 #c8501e #3d8c40'
# Factor and column COLUMN, as a multiple of what it is for factor 1 if RELATIVE.
of(kind, method, column, relative) = sprintf("< awk -F, '$2 == \"%s\" && $1 ~ /^%s / { split($1, name, \" \"); if (name[2] == 1) unit = %d ? $%d : 1; print name[2], $%d / unit }' scaling.csv", method, kind, relative, column, column)
set multiplot layout 2,2
do for [kind in 'area models'] {
  set xlabel (kind eq 'area' ? 'times the area, and the objects' : 'times the models')
  set title 'time, relative to the first'
  plot for [m = 1:3] of(kind, word(methods, m), 8, 1) with linespoints pt 7 ps 0.5 lc rgb word(colours, m) \
    title word(methods, m) noenhanced, x lc rgb '#999999' dt 2 title 'linear'
  set title 'recall times precision [%]'
  plot for [m = 1:3] of(kind, word(methods, m), 34, 0) with linespoints pt 7 ps 0.5 lc rgb word(colours, m) \
    title word(methods, m) noenhanced
}
unset multiplot
