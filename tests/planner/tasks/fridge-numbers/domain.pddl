; A fridge whose open doors are counted, a robot with a battery: numbers in preconditions, effects and goals.
(define (domain fridge-numbers)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality :universal-preconditions
                 :conditional-effects :fluents)
  (:types robot thing)
  (:predicates (at ?r - robot ?x - thing) (in ?x ?y - thing) (holding ?r - robot ?x - thing) (fridge ?x - thing))
  (:functions (doors-open ?x - thing) (battery ?r - robot) (distance ?x ?y - thing) (weight ?x - thing)
              (load ?r - robot) (capacity ?r - robot))
  (:action go
    :parameters (?r - robot ?from ?to - thing)
    :precondition (and (at ?r ?from) (>= (battery ?r) (distance ?from ?to)) (not (= ?from ?to)))
    :effect (and (not (at ?r ?from)) (at ?r ?to) (decrease (battery ?r) (distance ?from ?to))))
  (:action charge
    :parameters (?r - robot)
    :precondition (< (battery ?r) 10)
    :effect (and (assign (battery ?r) 10)))
  (:action open
    :parameters (?r - robot ?x - thing)
    :precondition (and (at ?r ?x) (fridge ?x) (< (doors-open ?x) 1))
    :effect (and (increase (doors-open ?x) 1)))
  (:action close
    :parameters (?r - robot ?x - thing)
    :precondition (and (at ?r ?x) (fridge ?x) (> (doors-open ?x) 0))
    :effect (and (decrease (doors-open ?x) 1)))
  (:action pick
    :parameters (?r - robot ?x ?y - thing)
    :precondition (and (at ?r ?y) (in ?x ?y) (<= (+ (load ?r) (weight ?x)) (capacity ?r)))
    :effect (and (not (in ?x ?y)) (holding ?r ?x) (increase (load ?r) (weight ?x))))
  (:action put
    :parameters (?r - robot ?x ?y - thing)
    :precondition (and (at ?r ?y) (holding ?r ?x) (or (not (fridge ?y)) (> (doors-open ?y) 0)))
    :effect (and (in ?x ?y) (not (holding ?r ?x)) (decrease (load ?r) (weight ?x)))))
