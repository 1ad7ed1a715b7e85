# trajectory_form.tcl: the tab for a trajectory: its frames, their reference and potential, and the results' file.

namespace eval ::espdiff::gui {
    variable form
    array set form {trajectory,mol "" trajectory,file "" trajectory,sel "not water" trajectory,frames all
        trajectory,against "the frame" trajectory,reference 0 trajectory,map automatic trajectory,unit "as the map says"
        trajectory,csv trajectory.csv trajectory,resume 0 trajectory,skip 0
        trajectory,steps 0 trajectory,residues 0 trajectory,other "" trajectory,average 1}
    variable references {"the frame" "the frame before" "the same frame of"}
    variable automatic_trajectory ""  ;# the molecule chosen automatically, until the user chooses

    proc build_trajectory {path} {
        ttk::labelframe $path.frames -text Frames -padding 6
        if {[in_vmd]} { build_frames_of_molecule $path.frames } else { build_frames_of_file $path.frames }
        build_frame_rows $path.frames
        build_output_rows $path.frames
        grid columnconfigure $path.frames 1 -weight 1 -uniform field
        grid columnconfigure $path.frames 3 -weight 1 -uniform field
        build_trajectory_bar $path.bar
        ttk::labelframe $path.plot -text "Along the trajectory" -padding 6
        build_trajectory_plot $path.plot
        pack $path.frames $path.bar -fill x -padx 8 -pady {6 0}
        pack $path.plot -fill both -expand 1 -padx 8 -pady 6
        update_trajectory
    }

    proc build_frames_of_molecule {path} {
        variable widget
        ttk::combobox $path.mol -textvariable ::espdiff::gui::form(trajectory,mol) -state readonly -width 16 \
            -postcommand {::espdiff::gui::guard_in trajectory ::espdiff::gui::update_trajectory}
        bind $path.mol <<ComboboxSelected>> {::espdiff::gui::guard_in trajectory ::espdiff::gui::choose_trajectory}
        form_row $path 0 Molecule $path.mol "A molecule that is loaded in VMD, with its frames"
        ttk::entry $path.sel -textvariable ::espdiff::gui::form(trajectory,sel) -width 16
        form_row $path 0 Atoms $path.sel "VMD selection of the atoms that make the surface, such as: protein; chosen\
            once, in the reference frame" 2
        grid configure $path.label_sel -padx {16 6}
        foreach name {mol sel} { set widget(trajectory,$name) $path.$name }
    }

    proc build_frames_of_file {path} {
        variable widget
        variable structure_types
        ttk::frame $path.choose
        ttk::entry $path.choose.file -textvariable ::espdiff::gui::form(trajectory,file) -width 16
        button $path.choose.browse ... [list ::espdiff::gui::browse_trajectory file $structure_types]
        pack $path.choose.browse -side right -padx {4 0}
        pack $path.choose.file -fill x -expand 1
        form_row $path 0 File $path.choose "Structure file (PQR, PDB, mmCIF, GRO, MOL2) whose models are the frames; the first one\
            is frame 0"
        tip $path.choose.file "Structure file whose models are the frames; the first is frame 0"
        grid configure $path.choose -columnspan 3
        set widget(trajectory,file) $path.choose.file
    }

    proc build_frame_rows {path} {
        variable widget
        variable references
        ttk::entry $path.frames -textvariable ::espdiff::gui::form(trajectory,frames) -width 16
        form_row $path 1 Frames $path.frames "all, a frame, begin:end or begin:step:end, such as 0:10:end for every\
            tenth up to the last one"
        ttk::frame $path.against
        ttk::combobox $path.against.what -textvariable ::espdiff::gui::form(trajectory,against) -state readonly \
            -width 13 -values $references
        ttk::spinbox $path.against.frame -textvariable ::espdiff::gui::form(trajectory,reference) -width 6 -from 0 \
            -to 999999 -increment 1
        bind $path.against.what <<ComboboxSelected>> {::espdiff::gui::guard_in trajectory ::espdiff::gui::update_trajectory}
        set tip "The other trajectory, whose frame of the same number each frame is compared with"
        if {[in_vmd]} {
            ttk::combobox $path.against.other -textvariable ::espdiff::gui::form(trajectory,other) -state readonly \
                -width 8 -postcommand {::espdiff::gui::guard_in trajectory ::espdiff::gui::update_trajectory}
            append tip ": a molecule with its frames"
        } else {
            ttk::entry $path.against.other -textvariable ::espdiff::gui::form(trajectory,other) -width 8
            append tip ": a file with its models"
        }
        tip $path.against.other $tip
        pack $path.against.what -side left -fill x -expand 1
        pack $path.against.frame -side left -padx {4 0}
        form_row $path 1 Against $path.against "What each frame is compared with: one frame for all, the frame before\
            it in the run, or the frame of the same number of another trajectory" 2
        tip $path.against.what "What each frame is compared with"
        tip $path.against.frame "Number of the reference frame"
        grid configure $path.label_against -padx {16 6}
        foreach name {frames against} { set widget(trajectory,$name) $path.$name }
        set widget(trajectory,against) $path.against.what
        set widget(trajectory,reference) $path.against.frame
        set widget(trajectory,other) $path.against.other
    }

    proc build_output_rows {path} {
        variable widget
        variable units
        ttk::combobox $path.map -textvariable ::espdiff::gui::form(trajectory,map) -width 16 \
            -postcommand {::espdiff::gui::guard_in trajectory ::espdiff::gui::update_trajectory}
        form_row $path 2 Potential $path.map "Of each frame: computed from the charges; a map\
            file for each frame, such as map%03d.dx, where %03d stands for the frame's number; a data set or a file\
            for all frames; or none to compare the shapes alone"
        ttk::combobox $path.unit -textvariable ::espdiff::gui::form(trajectory,unit) -values $units -state readonly \
            -width 16
        form_row $path 2 Unit $path.unit "Unit of the maps, if they do not say" 2
        grid configure $path.label_unit -padx {16 6}
        ttk::frame $path.csv
        ttk::entry $path.csv.name -textvariable ::espdiff::gui::form(trajectory,csv) -width 16
        button $path.csv.browse ... ::espdiff::gui::choose_csv
        pack $path.csv.browse -side right -padx {4 0}
        pack $path.csv.name -fill x -expand 1
        form_row $path 3 Results $path.csv "CSV file; each frame's row is written as soon as it is done"
        tip $path.csv.name "CSV file; each frame's row is written as soon as it is done"
        ttk::frame $path.options
        ttk::checkbutton $path.options.resume -text "resume" -variable ::espdiff::gui::form(trajectory,resume)
        ttk::checkbutton $path.options.skip -text "skip what fails" -variable ::espdiff::gui::form(trajectory,skip)
        tip $path.options.resume "Resume an interrupted run in this file, with the same frames and settings"
        tip $path.options.skip "A frame that cannot be compared becomes a row with the reason, and the run continues"
        ttk::checkbutton $path.options.residues -text "residues" -variable ::espdiff::gui::form(trajectory,residues)
        tip $path.options.residues "Also write one value of each residue for each frame, into a second CSV file, and\
            offer it below as a map (Metric: By residue)"
        pack $path.options.resume $path.options.skip $path.options.residues -side left -padx {0 10}
        grid $path.options -row 3 -column 2 -columnspan 2 -sticky w -padx {16 0}
        ttk::label $path.note -text "The settings are those of the tab Pair." -foreground gray40
        grid $path.note -row 5 -column 0 -columnspan 4 -sticky w
        if {[in_vmd]} {
            build_average $path.average
            grid $path.average -row 4 -column 0 -columnspan 2 -sticky w
        } else {
            grid configure $path.note -row 4 -columnspan 2
        }
        ttk::checkbutton $path.steps -text "in small steps" -variable ::espdiff::gui::form(trajectory,steps)
        tip $path.steps "Each surface continues from the frame before, where that is much nearer than the reference:\
            takes half the time, and loses a little more of the surface. A frame that is chosen below is\
            compared with the reference directly"
        grid $path.steps -row 4 -column 2 -columnspan 2 -sticky w -padx {16 0}
        foreach name {map unit} { set widget(trajectory,$name) $path.$name }
        set widget(trajectory,csv) $path.csv.name
        set widget(trajectory,steps) $path.steps
        foreach name {resume skip residues} { set widget(trajectory,$name) $path.options.$name }
    }

    # The water of single frames makes most of their potential by PME.
    proc build_average {path} {
        ttk::frame $path
        ttk::label $path.over -text "Average over"
        ttk::spinbox $path.n -textvariable ::espdiff::gui::form(trajectory,average) -width 4 -from 1 -to 9999 -increment 1
        ttk::label $path.frames -text "frames"
        foreach name {over n frames} {
            tip $path.$name "Of PME with explicit water: each frame gets the mean potential over so many frames around it,\
                superposed on it. 1: its own, which is mostly that of the water at that moment"
        }
        pack $path.over $path.n $path.frames -side left -padx {0 4}
        set ::espdiff::gui::widget(trajectory,average) $path.n
    }

    # VMD's current molecules and data sets.
    proc update_trajectory {} {
        variable form
        variable widget
        variable computed
        variable references
        variable automatic_trajectory
        set maps [concat none [dict keys $computed]]
        if {[in_vmd]} {
            set names [molecule_names]
            $widget(trajectory,mol) configure -values $names
            # A molecule keeps its number when it is renamed.
            set chosen [lsearch -inline $names "[number_of $form(trajectory,mol)]: *"]
            if {$chosen eq "" || $form(trajectory,mol) eq $automatic_trajectory} {
                set chosen [most_frames $names]
                set automatic_trajectory $chosen
            }
            set form(trajectory,mol) $chosen
            set mol [number_of $form(trajectory,mol)]
            if {$mol ne ""} { lappend maps {*}[data_set_names $mol] }
        }
        $widget(trajectory,map) configure -values $maps
        $widget(trajectory,reference) state [expr {$form(trajectory,against) eq [lindex $references 0] ? "!disabled"
            : "disabled"}]
        # One of both has the place beside the list.
        set is_other [expr {$form(trajectory,against) eq [lindex $references 2]}]
        pack forget $widget(trajectory,reference) $widget(trajectory,other)
        pack $widget(trajectory,[expr {$is_other ? "other" : "reference"}]) -side left -padx {4 0}
        if {$is_other && [in_vmd]} {
            set others [lsearch -all -inline -not -exact [molecule_names] $form(trajectory,mol)]
            $widget(trajectory,other) configure -values $others
            if {$form(trajectory,other) ni $others} { set form(trajectory,other) [most_frames $others] }
        }
        show_trajectory_running
    }

    proc choose_trajectory {} {
        variable automatic_trajectory ""
        update_trajectory
    }

    # The molecule with most frames.
    proc most_frames {names} {
        set best ""
        set most 0
        foreach name $names {
            set n [molinfo [number_of $name] get numframes]
            if {$n > $most} { set best $name; set most $n }
        }
        return $best
    }

    proc browse_trajectory {field types} {
        variable window
        variable form
        set path [tk_getOpenFile -parent $window -filetypes $types]
        if {$path ne ""} { set form(trajectory,$field) $path }
    }

    proc choose_csv {} {
        variable window
        variable form
        set path [tk_getSaveFile -parent $window -title "Rows go to" -initialfile [file tail $form(trajectory,csv)] \
            -defaultextension .csv -filetypes {{"Tables" .csv} {"All files" *}} -confirmoverwrite 0]
        if {$path ne ""} { set form(trajectory,csv) $path }
    }

    # The form as options of `espdiff trajectory`, without the output.
    proc trajectory_options {} {
        variable form
        variable references
        if {[in_vmd]} {
            set mol [number_of $form(trajectory,mol)]
            if {$mol eq ""} { error "no molecule is chosen; load one with a trajectory into VMD" }
            set options [list -mol $mol]
            if {$form(trajectory,sel) ne "not water"} { lappend options -sel $form(trajectory,sel) }
        } else {
            set path [string trim $form(trajectory,file)]
            if {$path eq ""} { error "File: no file is given; type its name or use the button beside it" }
            set options [list -file $path]
        }
        lappend options -frames [string trim $form(trajectory,frames)]
        if {$form(trajectory,against) eq [lindex $references 0]} {
            lappend options -reference [list frame [string trim $form(trajectory,reference)]]
        } elseif {$form(trajectory,against) eq [lindex $references 1]} {
            lappend options -reference previous
        } else {
            lappend options -reference [list {*}[other_trajectory] frame same]
        }
        set map [trajectory_map]
        if {$map ne ""} { lappend options -map $map }
        if {$map ni {"" none} && ![::espdiff::is_computed $map] && $form(trajectory,unit) ne "as the map says"} {
            lappend options -unit $form(trajectory,unit)
        }
        if {$form(trajectory,skip)} { lappend options -on-error skip }
        if {$form(trajectory,steps)} { lappend options -start previous }
        return $options
    }

    # With the average that the form asks for.
    proc averaged_word {word} {
        variable form
        set n [string trim $form(trajectory,average)]
        if {![string is integer -strict $n] || $n < 1} { error "Average over: '$n' is not a number of frames from 1" }
        if {$n == 1} { return $word }
        if {[lindex $word 0] ne "pme"} {
            error "Average over $n frames: only PME, explicit water, is averaged; choose it as Potential, or average over 1"
        }
        return [concat $word [list average $n]]
    }

    proc other_trajectory {} {
        variable form
        set other [string trim $form(trajectory,other)]
        if {$other eq ""} {
            error "Against: [expr {[in_vmd] ? "there is no other molecule with frames; load one" : "no file is given"}]"
        }
        return [expr {[in_vmd] ? [list mol [number_of $other]] : [list file $other]}]
    }

    # In the form of -map; empty for the usual potential.
    proc trajectory_map {} {
        variable form
        variable computed
        set map [string trim $form(trajectory,map)]
        if {$map in {none ""}} { return none }
        if {[is_computed_map $map]} { return [averaged_word [computed_map_word $map]] }
        if {[in_vmd] && [number_of $map] ne ""} { return [number_of $map] }
        return [list [expr {[string first % $map] >= 0 ? "files" : "file"}] $map]
    }
}
