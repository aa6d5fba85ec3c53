# Run in this folder: gnuplot experiment_46.gnuplot
set terminal svg size 900,900 background rgb 'white'
set output 'experiment_46.svg'
set datafile separator ','
set multiplot layout 3,2
set logscale y
set xlabel 'r'
set key bottom right
names = 'list octree avl linear'
set title 's = 0.001: time per search [us]'
plot for [m=0:3] 'experiment_46.csv' skip 1 using (abs($1-0.001)<1e-6 ? $2 : NaN):(column(4+3*m)) with linespoints pt 7 ps 0.4 title word(names, m+1)
set title 's = 0.001: relative time (4.32) [%] + 1'
plot for [m=0:2] 'experiment_46.csv' skip 1 using (abs($1-0.001)<1e-6 ? $2 : NaN):(column(5+3*m)+1) with linespoints pt 7 ps 0.4 title word(names, m+1)
set title 's = 0.056: time per search [us]'
plot for [m=0:3] 'experiment_46.csv' skip 1 using (abs($1-0.056)<1e-6 ? $2 : NaN):(column(4+3*m)) with linespoints pt 7 ps 0.4 title word(names, m+1)
set title 's = 0.056: relative time (4.32) [%] + 1'
plot for [m=0:2] 'experiment_46.csv' skip 1 using (abs($1-0.056)<1e-6 ? $2 : NaN):(column(5+3*m)+1) with linespoints pt 7 ps 0.4 title word(names, m+1)
set title 's = 0.1: time per search [us]'
plot for [m=0:3] 'experiment_46.csv' skip 1 using (abs($1-0.1)<1e-6 ? $2 : NaN):(column(4+3*m)) with linespoints pt 7 ps 0.4 title word(names, m+1)
set title 's = 0.1: relative time (4.32) [%] + 1'
plot for [m=0:2] 'experiment_46.csv' skip 1 using (abs($1-0.1)<1e-6 ? $2 : NaN):(column(5+3*m)+1) with linespoints pt 7 ps 0.4 title word(names, m+1)
unset multiplot
