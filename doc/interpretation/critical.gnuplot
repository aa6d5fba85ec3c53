# Run where critical.csv is (see scripts/evaluate_scenes.sh): gnuplot critical.gnuplot
set terminal svg size 900,760 background rgb 'white'
set output 'critical.svg'
set yrange [0:105]
set grid
set xlabel 'distance [smaller bounding radius]'
set ylabel '%'
set key outside bottom center horizontal
methods = 'dissertation explanation classic_vfh'
colours = '#1f5fa8 #c8501e #3d8c40'
# Distance and column COLUMN of METHOD in scenes of KIND.
of(kind, method, column) = sprintf("< awk -F, '$2 == \"%s\" && $1 ~ /^%s / { split($1, name, \" \"); print name[2], $%d }' critical.csv", method, kind, column)
set multiplot layout 2,2
do for [kind in 'free table'] {
  do for [which = 1:2] {
    set title (kind eq 'free' ? 'two in free space: ' : 'two on a table: ').(which == 1 ? 'classification (5.9)' : 'recall')
    at = which == 1 ? 21 : 27
    plot for [m = 1:3] of(kind, word(methods, m), at) with linespoints pt 7 ps 0.5 lc rgb word(colours, m) \
      title word(methods, m) noenhanced
  }
}
unset multiplot
