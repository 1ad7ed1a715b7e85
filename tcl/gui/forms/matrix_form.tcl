# matrix_form.tcl: the tab for many variants: the list, their potential, and the results' name.

namespace eval ::espdiff::gui {
    variable form
    array set form {matrix,mol "" matrix,frames now matrix,sel "not water" matrix,label "" matrix,group ""
        matrix,potential automatic matrix,output matrix matrix,resume 0 matrix,template ""}
    variable variants {}      ;# dicts: endpoint (without map), label, group, what (a description)
    variable data_set "data set 0 of each"

    proc build_matrix {path} {
        variable widget
        ttk::labelframe $path.variants -text Variants -padding 6
        build_variant_list $path.variants
        if {[in_vmd]} { build_add_row $path.variants.add }
        build_label_row $path.variants.edit
        ttk::labelframe $path.run -text Computation -padding 6
        build_matrix_settings $path.run
        build_matrix_bar $path.bar
        ttk::labelframe $path.result -text "Each with each" -padding 6
        build_heat_map $path.result
        pack $path.variants $path.run $path.bar -fill x -padx 8 -pady {6 0}
        pack $path.result -fill both -expand 1 -padx 8 -pady 6
        show_variants
    }

    proc build_variant_list {path} {
        variable widget
        ttk::treeview $path.list -columns {label group what} -show headings -style Espdiff.Treeview -height 5 -selectmode extended \
            -yscrollcommand [list $path.scroll set]
        $path.list heading label -text Label -anchor w
        $path.list heading group -text Group -anchor w
        $path.list heading what -text "Molecule or file" -anchor w
        $path.list column label -width [scaled 130]
        $path.list column group -width [scaled 80] -stretch 0
        $path.list column what -width [scaled 240]
        ttk::scrollbar $path.scroll -orient vertical -command [list $path.list yview] -takefocus 0
        ttk::frame $path.buttons
        button $path.buttons.files "Add files..." ::espdiff::gui::browse_variants
        button $path.buttons.remove Remove ::espdiff::gui::remove_variants
        tip $path.buttons.files "Structures (PQR, PDB, mmCIF, GRO, MOL2); each model of a file is a variant"
        tip $path.buttons.remove "Take the selected variants off the list (Delete)"
        pack $path.buttons.files $path.buttons.remove -side top -fill x -pady {0 4}
        grid $path.list $path.scroll $path.buttons -sticky news
        grid configure $path.buttons -padx {6 0}
        grid columnconfigure $path 0 -weight 1
        bind $path.list <<TreeviewSelect>> {::espdiff::gui::guard_in matrix ::espdiff::gui::select_variant}
        bind $path.list <Delete> {::espdiff::gui::guard_in matrix ::espdiff::gui::remove_variants}
        set widget(matrix,list) $path.list
        set widget(matrix,files) $path.buttons.files
        set widget(matrix,remove) $path.buttons.remove
    }

    # Molecule, frames and atoms to add.
    proc build_add_row {path} {
        variable widget
        ttk::frame $path
        ttk::combobox $path.mol -textvariable ::espdiff::gui::form(matrix,mol) -state readonly -width 14 \
            -postcommand {::espdiff::gui::guard_in matrix ::espdiff::gui::update_matrix}
        ttk::entry $path.frames -textvariable ::espdiff::gui::form(matrix,frames) -width 9
        ttk::entry $path.sel -textvariable ::espdiff::gui::form(matrix,sel) -width 14
        button $path.add "Add molecule" ::espdiff::gui::add_molecule
        tip $path.mol "A molecule that is loaded in VMD"
        tip $path.frames "Frames: now, all, a number from 0, begin:end or begin:step:end, such as\
            0:10:end for every tenth"
        tip $path.sel "VMD selection of the atoms of the surface, such as: protein"
        ttk::label $path.frames_label -text frames
        ttk::label $path.sel_label -text atoms
        pack $path.add -side right -padx {6 0}
        pack $path.mol -side left -fill x -expand 1
        pack $path.frames_label $path.frames $path.sel_label $path.sel -side left -padx {6 0}
        grid $path -row 1 -column 0 -columnspan 3 -sticky ew -pady {6 0}
        foreach name {mol frames sel add} { set widget(matrix,$name) $path.$name }
    }

    # Label and group of the selected variants.
    proc build_label_row {path} {
        variable widget
        ttk::frame $path
        foreach {name text help} {
            label "Label" "Name of the selected variant in the results"
            group "Group" "Group of the selected variants: means of groups are computed, and groups framed"
        } {
            ttk::label $path.${name}_label -text $text
            ttk::entry $path.$name -textvariable ::espdiff::gui::form(matrix,$name) -width 16
            tip $path.$name $help
            pack $path.${name}_label $path.$name -side left -padx {0 6}
            bind $path.$name <KeyRelease> [list ::espdiff::gui::guard_in matrix ::espdiff::gui::rename_variants $name]
            set widget(matrix,$name) $path.$name
        }
        grid $path -row 2 -column 0 -columnspan 3 -sticky ew -pady {6 0}
    }

    proc build_matrix_settings {path} {
        variable widget
        variable computed
        variable data_set
        ttk::combobox $path.potential -textvariable ::espdiff::gui::form(matrix,potential) -state readonly -width 18 \
            -values [concat none [dict keys $computed] [expr {[in_vmd] ? [list $data_set] : {}}]]
        form_row $path 0 Potential $path.potential "Of every variant: computed from its charges,\
            in VMD the molecule's data set, or none to compare the shapes alone"
        ttk::entry $path.output -textvariable ::espdiff::gui::form(matrix,output) -width 16
        form_row $path 0 "Results" $path.output "Files begin with this: NAME.csv and NAME.json, and NAME.state while\
            the run continues; with a template NAME.h5 too" 2
        ttk::combobox $path.template -textvariable ::espdiff::gui::form(matrix,template) -width 18 -values {{} medoid}
        form_row $path 1 Template $path.template "Empty: compare each pair by itself. Otherwise map one surface onto\
            each variant, which is faster with many variants and gives differences of potentials only: medoid (the\
            variant nearest to all others), a label, or a structure file"
        ttk::checkbutton $path.resume -text "resume an interrupted run" \
            -variable ::espdiff::gui::form(matrix,resume)
        tip $path.resume "Needs its state file, and the same variants and settings"
        grid $path.resume -row 1 -column 3 -sticky w
        ttk::label $path.note -text "The settings are those of the tab Pair." -foreground gray40
        grid $path.note -row 2 -column 0 -columnspan 4 -sticky w
        grid configure $path.label_output -padx {16 6}
        grid columnconfigure $path {1 3} -weight 1
        foreach name {potential output resume template} { set widget(matrix,$name) $path.$name }
    }

    proc show_variants {} {
        variable variants
        fill_list matrix $variants variant_cells
        update_matrix
    }

    proc variant_cells {variant} {
        list [dict get $variant label] [dict get $variant group] [dict get $variant what]
    }

    proc update_matrix {} {
        update_list matrix
        show_matrix_running
    }

    proc add_variant {endpoint label what} {
        variable variants
        set taken {}
        foreach variant $variants { lappend taken [dict get $variant label] }
        set name $label
        for {set i 2} {$name in $taken} {incr i} { set name "$label #$i" }
        lappend variants [dict create endpoint $endpoint label $name group "" what $what]
    }

    proc add_molecule {} {
        variable form
        set mol [number_of $form(matrix,mol)]
        if {$mol eq ""} { error "no molecule is chosen; load one into VMD" }
        set name [file rootname [molinfo $mol get name]]
        set frames [::espdiff::vmd_frames $mol [string trim $form(matrix,frames)] Frames]
        check_selection $mol [lindex $frames 0] $form(matrix,sel)
        foreach frame $frames {
            set endpoint [list mol $mol frame $frame]
            if {$form(matrix,sel) ne "not water"} { lappend endpoint sel $form(matrix,sel) }
            set label [expr {[molinfo $mol get numframes] == 1 ? $name : "$name:$frame"}]
            add_variant $endpoint $label "molecule $form(matrix,mol), frame $frame"
        }
        show_variants
    }

    proc browse_variants {} {
        variable window
        variable structure_types
        set paths [tk_getOpenFile -parent $window -filetypes $structure_types -multiple 1]
        if {[llength $paths] > 0} { add_files $paths }
    }

    proc add_files {paths} {
        foreach path $paths {
            set name [file rootname [file tail $path]]
            set n [::espdiff::core::models [::espdiff::existing_file $path variants]]
            for {set model 1} {$model <= $n} {incr model} {
                add_variant [expr {$n == 1 ? [list file $path] : [list file $path model $model]}] \
                    [expr {$n == 1 ? $name : "$name:$model"}] \
                    [expr {$n == 1 ? [near_name $path] : "[near_name $path], model $model"}]
            }
        }
        show_variants
    }

    # File and folder: the end of a path is the informative part.
    proc near_name {path} { file join {*}[lrange [file split [file normalize $path]] end-1 end] }

    proc remove_variants {} {
        variable variants
        variable widget
        foreach number [lsort -integer -decreasing [$widget(matrix,list) selection]] {
            set variants [lreplace $variants $number $number]
        }
        show_variants
    }

    proc select_variant {} {
        variable form
        variable variants
        variable widget
        set first [lindex [$widget(matrix,list) selection] 0]
        foreach key {label group} {
            set form(matrix,$key) [expr {$first eq "" ? "" : [dict get [lindex $variants $first] $key]}]
        }
        set_enabled [expr {[llength [$widget(matrix,list) selection]] == 1}] $widget(matrix,label)
        update_matrix
    }

    # Applies the typed text to the selected variants: a group to all of them, a label to one.
    proc rename_variants {key} {
        variable form
        variable variants
        variable widget
        foreach number [$widget(matrix,list) selection] {
            set variant [lindex $variants $number]
            dict set variant $key [string trim $form(matrix,$key)]
            lset variants $number $variant
            $widget(matrix,list) item $number -values [variant_cells $variant]
        }
    }

    # In the form of `espdiff compare`.
    proc variant_endpoint {variant} {
        variable form
        variable computed
        variable data_set
        set endpoint [dict get $variant endpoint]
        if {$form(matrix,potential) eq $data_set} { return [concat $endpoint {map 0}] }
        if {![dict exists $computed $form(matrix,potential)]} { return [concat $endpoint {map none}] }
        set word [computed_map_word $form(matrix,potential)]
        if {$word ne ""} { return [concat $endpoint [list map $word]] }
        return $endpoint
    }

    # In the form of `espdiff matrix`.
    proc matrix_variants {} {
        variable variants
        set list {}
        foreach variant $variants {
            lappend list [concat [variant_endpoint $variant] [list label [dict get $variant label]] \
                [list group [dict get $variant group]]]
        }
        return $list
    }
}
