# Run where online.csv is (pcl_surflet_evaluate_online -csv, see online.md): gnuplot online.gnuplot
set terminal svg size 900,760 background rgb 'white'
set output 'online.svg'
set datafile separator ','
set grid
set key top left
lengths = '1 2 4 8'
colours = '#1f5fa8 #3d8c40 #c8501e #7a4fa0'
of(length, columns) = sprintf("< awk -F, '$1 == %s && $2 == 1001 { print %s }' OFS=, online.csv", length, columns)
set multiplot layout 2,2
set xlabel 'scan'
set yrange [0:*]
set yrange [0:29]
set title 'table of 4 m: things known'
plot of('4', '$3, $10') using 1:2 with steps lc rgb '#1f5fa8' title 'detections', \
     of('4', '$3, $11') using 1:2 with steps lc rgb '#3d8c40' title 'of these confident', \
     of('4', '$3, $9') using 1:2 with impulses lc rgb '#c8501e' title 'sought again'
set yrange [0:0.75]
set title 'table of 4 m: seconds'
plot of('4', '$3, $12') using 1:2 with lines lc rgb '#1f5fa8' title 'online', \
     of('4', '($13 > 0 ? $3 "," $13 : "")') using 1:2 with linespoints pt 7 ps 0.4 lc rgb '#c8501e' title 'batch of all so far'
set yrange [0:0.3]
set title 'seconds of a scan'
plot for [k = 1:4] of(word(lengths, k), '$3, $12') using 1:2 with lines lc rgb word(colours, k) \
  title word(lengths, k).' m'
set yrange [0:*]
set title 'a scan of the second half (median) and the last batch'
set xlabel 'length of the table [m]'
set ylabel 's'
set xrange [0:8.5]
med = "< for l in 1 2 4 8; do awk -F, -v l=$l '$1 == l && $3 > 14 * l / 2 { print $12 }' online.csv | sort -n | awk -v l=$l '{ v[NR] = $1 } END { print l \",\" v[int((NR + 1) / 2)] }'; done"
last = "< for l in 1 2 4 8; do awk -F, -v l=$l '$1 == l && $13 > 0 { last[$2] = $13 } END { for (s in last) print l \",\" last[s] }' online.csv; done"
plot med using 1:2 with linespoints pt 7 ps 0.6 lc rgb '#1f5fa8' title 'online', \
     last using 1:2 with points pt 7 ps 0.6 lc rgb '#c8501e' title 'batch'
unset multiplot
