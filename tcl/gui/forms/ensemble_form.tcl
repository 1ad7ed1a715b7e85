# ensemble_form.tcl: the tab for groups of simulations: the list of replicates, their potential, and the results' name.

namespace eval ::espdiff::gui {
    variable form
    array set form {ensemble,mol "" ensemble,frames all ensemble,sel "not water" ensemble,group first ensemble,label ""
        ensemble,potential automatic ensemble,output ensemble ensemble,resume 0 ensemble,control TFCE
        ensemble,regress ""}
    variable replicates {}  ;# dicts: endpoint (without label), group, label, what (a description)

    proc build_ensemble {path} {
        ttk::labelframe $path.replicates -text "Replicates: one simulation each" -padding 6
        build_replicate_list $path.replicates
        build_replicate_row $path.replicates.add
        ttk::labelframe $path.run -text Computation -padding 6
        build_ensemble_settings $path.run
        build_ensemble_bar $path.bar
        ttk::labelframe $path.result -text "Where the groups differ" -padding 6
        build_ensemble_result $path.result
        pack $path.replicates $path.run $path.bar -fill x -padx 8 -pady {6 0}
        pack $path.result -fill both -expand 1 -padx 8 -pady 6
        show_replicates
    }

    proc build_replicate_list {path} {
        variable widget
        ttk::treeview $path.list -columns {group label what} -show headings -style Espdiff.Treeview -height 4 -selectmode extended \
            -yscrollcommand [list $path.scroll set]
        foreach {column title width} {group Group 80 label Replicate 120 what "Molecule or file" 200} {
            $path.list heading $column -text $title -anchor w
            $path.list column $column -width [scaled $width]
        }
        ttk::scrollbar $path.scroll -orient vertical -command [list $path.list yview] -takefocus 0
        ttk::frame $path.buttons
        button $path.buttons.files "Add files..." ::espdiff::gui::browse_replicates
        button $path.buttons.remove Remove ::espdiff::gui::remove_replicates
        tip $path.buttons.files "Structures (PQR, PDB, mmCIF, GRO, MOL2) whose models are the frames; each file is a replicate"
        tip $path.buttons.remove "Take the selected replicates off the list (Delete)"
        pack $path.buttons.files $path.buttons.remove -side top -fill x -pady {0 4}
        grid $path.list $path.scroll $path.buttons -sticky news
        grid configure $path.buttons -padx {6 0}
        grid columnconfigure $path 0 -weight 1
        bind $path.list <<TreeviewSelect>> {::espdiff::gui::guard_in ensemble ::espdiff::gui::select_replicate}
        bind $path.list <Delete> {::espdiff::gui::guard_in ensemble ::espdiff::gui::remove_replicates}
        set widget(ensemble,list) $path.list
        foreach name {files remove} { set widget(ensemble,$name) $path.buttons.$name }
    }

    # Molecule, frames, atoms and group to add; the group of what is selected.
    proc build_replicate_row {path} {
        variable widget
        ttk::frame $path
        ttk::combobox $path.group -textvariable ::espdiff::gui::form(ensemble,group) -width 7
        tip $path.group "Group of the next replicate, and of the selected ones: two groups are compared, one is\
            described"
        foreach event {<KeyRelease> <<ComboboxSelected>>} {
            bind $path.group $event {::espdiff::gui::guard_in ensemble ::espdiff::gui::rename_replicates}
        }
        pack [ttk::label $path.group_label -text group] $path.group -side left -padx {0 6}
        if {[in_vmd]} {
            ttk::combobox $path.mol -textvariable ::espdiff::gui::form(ensemble,mol) -state readonly -width 11 \
                -postcommand {::espdiff::gui::guard_in ensemble ::espdiff::gui::update_ensemble}
            ttk::entry $path.frames -textvariable ::espdiff::gui::form(ensemble,frames) -width 6
            ttk::entry $path.sel -textvariable ::espdiff::gui::form(ensemble,sel) -width 8
            button $path.add "Add molecule" ::espdiff::gui::add_replicate_of_molecule
            tip $path.mol "A molecule that is loaded in VMD, with the frames of one simulation"
            tip $path.frames "Frames: all, begin:end or begin:step:end, such as 0:10:end for every tenth"
            tip $path.sel "VMD selection of the atoms of the surface, such as: protein"
            pack $path.add -side right -padx {6 0}
            pack $path.mol -side left -fill x -expand 1
            pack [ttk::label $path.frames_label -text frames] $path.frames [ttk::label $path.sel_label -text atoms] \
                $path.sel -side left -padx {6 0}
            foreach name {mol frames sel add} { set widget(ensemble,$name) $path.$name }
        }
        grid $path -row 1 -column 0 -columnspan 3 -sticky ew -pady {6 0}
        set widget(ensemble,group) $path.group
    }

    proc build_ensemble_settings {path} {
        variable widget
        variable computed
        ttk::combobox $path.potential -textvariable ::espdiff::gui::form(ensemble,potential) -state readonly -width 18 \
            -values [dict keys $computed]
        form_row $path 0 Potential $path.potential "Of every frame, computed from its charges"
        ttk::entry $path.output -textvariable ::espdiff::gui::form(ensemble,output) -width 16
        form_row $path 0 Results $path.output "Files begin with this: NAME.h5 with the potential of each frame, NAME.json,\
            NAME.vtp and tables" 2
        ttk::combobox $path.control -textvariable ::espdiff::gui::form(ensemble,control) -state readonly -width 18 \
            -values {TFCE max-t}
        form_row $path 1 "Significant by" $path.control "TFCE finds broad differences, with the help of neighbours; max-t is\
            stricter, and local"
        ttk::checkbutton $path.resume -text "resume an interrupted run" \
            -variable ::espdiff::gui::form(ensemble,resume)
        tip $path.resume "Needs its NAME.h5, and the same replicates and settings; a complete one gets new statistics"
        grid $path.resume -row 1 -column 3 -sticky w
        ttk::entry $path.regress -textvariable ::espdiff::gui::form(ensemble,regress) -width 18
        form_row $path 2 "Regress on" $path.regress "A value of each replicate, such as an activity: TABLE.csv:COLUMN.\
            The table has the columns replicate, COLUMN, and group unless names are unique. Empty for none"
        button $path.browse "Choose table..." ::espdiff::gui::browse_regression
        tip $path.browse "A comma-separated table; its first column of numbers is taken"
        grid $path.browse -row 2 -column 3 -sticky w
        grid configure $path.label_output -padx {16 6}
        grid columnconfigure $path {1 3} -weight 1
        foreach name {potential output control resume regress browse} { set widget(ensemble,$name) $path.$name }
    }

    proc show_replicates {} {
        variable replicates
        fill_list ensemble $replicates replicate_cells
        update_ensemble
    }

    proc replicate_cells {replicate} {
        list [dict get $replicate group] [dict get $replicate label] [dict get $replicate what]
    }

    proc update_ensemble {} {
        variable widget
        update_list ensemble
        $widget(ensemble,group) configure -values [ensemble_groups]
        show_ensemble_running
    }

    # Names of groups, in order.
    proc ensemble_groups {} {
        variable replicates
        set names {}
        foreach replicate $replicates {
            if {[dict get $replicate group] ni $names} { lappend names [dict get $replicate group] }
        }
        return $names
    }

    proc add_replicate {endpoint label what} {
        variable replicates
        variable form
        set group [string trim $form(ensemble,group)]
        if {$group eq ""} { error "Group: no name is given" }
        set taken {}
        foreach replicate $replicates {
            if {[dict get $replicate group] eq $group} { lappend taken [dict get $replicate label] }
        }
        set name $label
        for {set i 2} {$name in $taken} {incr i} { set name "$label #$i" }
        lappend replicates [dict create endpoint $endpoint group $group label $name what $what]
    }

    proc add_replicate_of_molecule {} {
        variable form
        set mol [number_of $form(ensemble,mol)]
        if {$mol eq ""} { error "no molecule is chosen; load one into VMD" }
        set frames [string trim $form(ensemble,frames)]
        set numbers [::espdiff::vmd_frames $mol $frames Frames]
        check_selection $mol [lindex $numbers 0] $form(ensemble,sel)
        set n [llength $numbers]
        set endpoint [list mol $mol frames $frames]
        if {$form(ensemble,sel) ne "not water"} { lappend endpoint sel $form(ensemble,sel) }
        add_replicate $endpoint [file rootname [molinfo $mol get name]] "molecule $form(ensemble,mol), $n frames"
        show_replicates
    }

    proc browse_regression {} {
        variable window
        set path [tk_getOpenFile -parent $window -filetypes {{Tables .csv} {All *}}]
        if {$path ne ""} { choose_regression $path }
    }

    # The first column that neither names replicates nor holds a text.
    proc choose_regression {path} {
        variable form
        set table [::espdiff::core::read_csv $path]
        if {"replicate" ni [dict get $table columns]} { error "[file tail $path] has no column replicate" }
        foreach column [dict get $table columns] {
            if {$column in {group replicate}} continue
            set numbers 1
            foreach row [dict get $table rows] {
                if {![::espdiff::is_number [dict get $row $column]]} { set numbers 0 }
            }
            if {$numbers} { set form(ensemble,regress) $path:$column; return }
        }
        error "[file tail $path] has no column of numbers beside replicate and group"
    }

    proc browse_replicates {} {
        variable window
        variable structure_types
        set paths [tk_getOpenFile -parent $window -filetypes $structure_types -multiple 1]
        if {[llength $paths] > 0} { add_replicate_files $paths }
    }

    proc add_replicate_files {paths} {
        foreach path $paths {
            set n [::espdiff::core::models [::espdiff::existing_file $path replicates]]
            add_replicate [list file [file normalize $path]] [lindex [split [file tail $path] .] 0] \
                "[near_name $path], $n frames"
        }
        show_replicates
    }

    proc remove_replicates {} {
        variable replicates
        variable widget
        foreach number [lsort -integer -decreasing [$widget(ensemble,list) selection]] {
            set replicates [lreplace $replicates $number $number]
        }
        show_replicates
    }

    proc select_replicate {} {
        variable form
        variable replicates
        variable widget
        set first [lindex [$widget(ensemble,list) selection] 0]
        if {$first ne ""} { set form(ensemble,group) [dict get [lindex $replicates $first] group] }
        update_ensemble
    }

    # The typed group becomes that of the selected replicates.
    proc rename_replicates {} {
        variable form
        variable replicates
        variable widget
        set group [string trim $form(ensemble,group)]
        if {$group eq ""} return
        foreach number [$widget(ensemble,list) selection] {
            set replicate [lindex $replicates $number]
            dict set replicate group $group
            lset replicates $number $replicate
            $widget(ensemble,list) item $number -values [replicate_cells $replicate]
        }
        show_ensemble_running
    }

    # In the form of `espdiff ensemble`.
    proc ensemble_words {} {
        variable replicates
        set groups {}
        foreach name [ensemble_groups] {
            set list {}
            foreach replicate $replicates {
                if {[dict get $replicate group] ne $name} continue
                lappend list [concat [dict get $replicate endpoint] [list label [dict get $replicate label]]]
            }
            lappend groups $name $list
        }
        return $groups
    }

    # Replicates in the order of the results: group by group.
    proc ensemble_order {} {
        variable replicates
        set order {}
        foreach name [ensemble_groups] {
            foreach replicate $replicates { if {[dict get $replicate group] eq $name} { lappend order $replicate } }
        }
        return $order
    }
}
