# gnuplot -c scripts/draw_frames.gp OUT.png FRAME.csv...     (one to five frames)
# Draws frames that `squall run --save-every` wrote, from the side and below each other: every particle where it is,
# coloured by its speed [m/s].
set datafile separator ","
stats ARG2 using 2 every ::1 nooutput
set terminal pngcairo size 900, 60 + 250 * (ARGC - 1) font "sans,10"
set output ARG1
set multiplot layout ARGC - 1, 1
set size ratio -1
set key off
set palette defined (0 "#08306b", 0.35 "#2171b5", 0.7 "#6baed6", 1 "#c6dbef")
set cblabel "speed [m/s]"
set ylabel "y [m]"
set xrange [0:*]
set yrange [0:*]
array frames[5] = [ARG2, ARG3, ARG4, ARG5, ARG6]
do for [i = 1:ARGC - 1] {
  if (i == ARGC - 1) { set xlabel "x [m]" }
  plot frames[i] every ::1 using 2:3:(sqrt($5**2 + $6**2 + $7**2)) with points pointtype 7 pointsize 0.35 palette
}
unset multiplot
