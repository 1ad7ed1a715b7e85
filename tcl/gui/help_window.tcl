# help_window.tcl: the window's help.

namespace eval ::espdiff::gui {
    # Empty lines separate paragraphs; lines within them are rewrapped.
    variable help_text {
Where on the surface does the electrostatic potential of two states of a molecule differ, by how much, and can the
result be trusted?

1. Choose the source and the target: molecules loaded in VMD (with frame and atoms), or structure files. Potential is
a volumetric map: a data set of the molecule (from PMEPot or a DX file), or a map file; or it is computed from the
charges. Below Automatic stands what is computed, and why.

2. Compare maps the surface of the source onto that of the target and compares the potentials at corresponding points.
VMD stays usable; Cancel stops the computation. Closing the window stops it too.

3. The result says whether the mapping is trustworthy, and why not. The numbers are means over the surface,
weighted by area. The mapping has a direction: Swap exchanges the sides. Rest the mouse on a name for its meaning;
Table shows all numbers, Export writes them with the surface.

4. Draw colours the surface in VMD's window. Difference is target - source: red where it became more negative, blue
where more positive. Colours fade into grey where the slip is large: the values are less certain there. Unmatched
parts are grey and hatched. "Side by side"
draws source, target and difference in three views that the mouse rotates together; Undraw restores VMD's view.

5. Residues lists the means over each residue's part of the surface, the largest share of the difference first; click a
heading to sort. Selected rows are
highlighted in VMD, visible through the surface, and the view rotates to them; Clear highlight removes the yellow.
Colour atoms writes the numbers to VMD's field User and shows them; Restore colours undoes it.

6. Trajectory compares frames with one frame, or each with the previous one, and draws a point for each finished
frame. Hollow points are not trustworthy. A click on a point, or the arrow keys, show its frame in VMD; Compare and draw
(space bar) compares it again with its surface. Stop keeps the rows; with "resume", Compare computes the rest.

7. Matrix compares each of many states with every other one. A click on a cell compares and draws its pair.

8. Ensembles compares two groups of simulations. Each molecule with its frames is a replicate; four or more in each
group can show a difference of the states. The difference is drawn where it is more than noise, the rest is faded. A
click on a patch turns it to the front and plots its mean in every frame; a click in the plot shows that frame. Stop
keeps the frames; with "resume", Compare computes the rest.

Script shows the Tcl commands that repeat your actions in a new VMD; `espdiff help` in VMD's console explains them. Your entries are
remembered for the next session, except molecules and files.

Keys: Return computes, Escape cancels, Control-Tab goes to the next tab, Alt with an underlined letter presses a button,
Alt-S shows the settings, Tab moves on, F1 is this help, Control-W closes the window.
}

    proc show_help {} {
        variable help_text
        regsub -all {([^\n])\n([^\n])} [string trim $help_text] {\1 \2} text
        text_window help "espdiff: help" $text 0
    }
}
