"""Grades a class: finds submissions, checks them here or elsewhere, gives points, and writes what systems take."""
