# help_window.tcl: the window's help.

namespace eval ::espdiff::gui {
    # Paragraphs are parted by empty lines; the lines within them are broken anew.
    variable help_text {
Where on the surface does the electrostatic potential of two states of a molecule differ, by how much, and can that be
trusted?

1. Choose the source and the target: molecules that are loaded in VMD (with frame and atoms), or structure files.
Potential is a volumetric map: a data set of the molecule (as PMEPot or a DX file gives), or a map file. Without maps
the shapes alone are compared.

2. Compare maps the surface of the source onto that of the target and compares the potentials at corresponding points.
VMD stays usable meanwhile; Cancel ends it.

3. The result says whether the mapping is trustworthy, and if not, why. The numbers are means over the surface,
weighted by area. The mapping has a direction: Swap exchanges the sides. Rest the mouse on a name for its meaning;
Table shows all numbers, Export writes them with the surface.

4. Draw colours the surface in VMD's window. Difference is target - source: red where it became more negative, blue
where more positive. Parts that travelled far are transparent: their values are less certain. "Side by side" draws
source, target and difference in three views that the mouse turns together; Undraw puts VMD's view back.

5. Residues lists what each residue's share of the surface says; headings sort. Selected rows are highlighted in VMD,
also through the surface, and the view turns to them; Clear highlight takes the yellow away. Colour atoms puts the
numbers into VMD's field User.

6. Trajectory compares frames with one frame, or each with the one before, and draws a point as soon as a frame is
done. Hollow points are not trustworthy. A click on a point, or the arrow keys, show its frame in VMD; Compare and draw
(space bar) compares it anew with its surface. Stop keeps the rows, and "go on with it" computes the rest.

7. Matrix compares each of many states with each other one. A click on a cell compares and draws its pair.

Script shows the Tcl commands that do the same again; `espdiff help` in VMD's console explains them. What you enter is
remembered from one session to the next, without molecules and files.

Keys: Return computes, Escape cancels, Control-Tab goes to the next tab, Alt with an underlined letter presses a button,
Alt-S shows the settings, Tab goes on, F1 is this help, Control-W closes the window.
}

    proc show_help {} {
        variable help_text
        regsub -all {([^\n])\n([^\n])} [string trim $help_text] {\1 \2} text
        text_window help "espdiff: help" $text 0
    }
}
