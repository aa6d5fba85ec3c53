# Run where floating_paths.csv and accumulation.csv are: gnuplot chapter6.gnuplot
set datafile separator ','
set terminal svg size 900,760 background rgb 'white'
set output 'floating_paths.svg'
set grid
set size ratio -1
set xtics 0.05
set xlabel 'x [m]'
set ylabel 'z [m]'
unset key
set label 1 '' at 0,0 point pt 2 ps 1.5 lw 2 lc rgb 'black'
# A line a seed: paths are separated by an empty line where the step falls back to 0.
path(object) = sprintf("< awk -F, '$3 == \"%s\" { if ($6 == 0) print \"\"; print $7 \",\" $9 }' floating_paths.csv", object)
first(object) = sprintf("< awk -F, '$3 == \"%s\" && $6 == 0 { print $7 \",\" $9 }' floating_paths.csv", object)
last(object) = sprintf("< awk -F, '$3 == \"%s\" { if ($6 == 0 && NR > 2) print l; l = $7 \",\" $9 } END { print l }' floating_paths.csv", object)
set multiplot layout 2,2
do for [object in 'bottle carafe cup wine_glass'] {
  set title object.' (origin: its centroid)' noenhanced
  plot path(object) using 1:2 with lines lc rgb '#9db8d9', first(object) using 1:2 with points pt 6 ps 0.4 lc rgb '#1f5fa8', \
    last(object) using 1:2 with points pt 7 ps 0.5 lc rgb '#c8501e'
}
unset multiplot
set output 'accumulation.svg'
set terminal svg size 900,420 background rgb 'white'
set size noratio
unset label 1
set key bottom right
set xrange [0:8.5]
set xtics autofreq
unset ylabel
set xlabel 'runs (time grows with them in proportion)'
of(method, column) = sprintf("< awk -F, '$1 == \"%s\" { if (!n) n = $6; print $3 \",\" (%d == 6 ? 100 * $6 / n : $%d) }' accumulation.csv", method, column, column)
set multiplot layout 1,2
set title 'right cells, of those of one run [%]'
set yrange [90:140]
plot of('dissertation', 6) using 1:2 with linespoints pt 7 ps 0.5 lc rgb '#1f5fa8' title 'dissertation (apart)', \
  of('explanation', 6) using 1:2 with linespoints pt 7 ps 0.5 lc rgb '#c8501e' title 'explanation (piled up)'
set title 'precision [%]'
set yrange [50:105]
plot of('dissertation', 10) using 1:2 with linespoints pt 7 ps 0.5 lc rgb '#1f5fa8' title 'dissertation (apart)', \
  of('explanation', 10) using 1:2 with linespoints pt 7 ps 0.5 lc rgb '#c8501e' title 'explanation (piled up)'
unset multiplot
